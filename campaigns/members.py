"""Error bars of a study: every point is run at two resolutions and with several seeds."""

from collections.abc import Iterator
from math import exp, expm1, log
from typing import Annotated, Self

from pydantic import Field, model_validator

from engine.scene.collision import Collision
from engine.scene.fields import Frozen, Number, Positive, key
from engine.scene.scene import Seed


class ErrorBars(Frozen):
    """Members of each point of the study: two resolutions, each with all seeds."""

    coarser: Annotated[
        Number, Field(gt=0.0, lt=1.0), key("particles of the second resolution, as a fraction of the study's", "1")
    ] = 0.5
    seeds: Annotated[tuple[Seed, ...], Field(min_length=2), key("seeds of both resolutions", "1")]
    order: Annotated[Positive, key("order of convergence in particle spacing, by which errors are estimated", "1")] = (
        0.75
    )

    @model_validator(mode="after")
    def _seeds_differ(self) -> Self:
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError("'seeds' contains a value twice; give every seed once")
        return self

    @property
    def error_over_difference(self) -> float:
        """Error of the finer resolution over its difference to the coarser one, 1/(f^(-p/3) - 1) [-].

        An outcome q(N) = q + C N^(-p/3) of order p in the spacing of N particles differs by C N^(-p/3) (f^(-p/3) - 1)
        between N and f N of them.
        """
        exponent = log(self.coarser) * self.order / 3.0
        return exp(exponent) / -expm1(exponent)

    def members(self, collision: Collision) -> Iterator[tuple[dict[str, str | int], Collision]]:
        """Coordinates and settings of every collision of one point, the cheap ones first."""
        coarse = max(1, round(self.coarser * collision.particles))
        for resolution, particles in {"coarse": coarse, "fine": collision.particles}.items():
            for seed in self.seeds:
                changes = {"particles": particles, "seed": seed}
                yield {"resolution": resolution, "seed": seed}, collision.model_copy(update=changes)
