import numpy as np

from analysis.report.figures.surface import picture


def test_a_picture_shows_the_nearest_body() -> None:
    view = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 5.0], [10.0, 0.0, 0.0]])
    found = picture(view, np.array([0, 1, 0]), 1.0, 0.1)
    left, right, bottom, top = found.extent

    def at(x: float, y: float) -> np.ndarray:
        height, width = found.pixels.shape[:2]
        return found.pixels[int((y - bottom) / (top - bottom) * height), int((x - left) / (right - left) * width)]

    assert at(0.0, 0.0)[0] > at(0.0, 0.0)[2] and at(10.0, 0.0)[2] > at(10.0, 0.0)[0]
    assert at(5.0, 0.0)[3] == 0 and at(0.0, 0.0)[3] == 255
