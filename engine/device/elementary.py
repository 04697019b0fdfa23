"""Elementary functions in the precision of this process, also where the device has none in double precision.

Kernels for Vulkan have those of the device in single precision only. In double precision the functions below then use
arithmetic, square roots and the bits of a number: they err by 3 units in the last place at most, `log1p` and `expm1` by
4, and `power(x, y)` by 2^-52 (2 + |y ln x|) of its value. A positive argument of `log`, `cbrt` and `power` is a normal
number, `sin` and `cos` take |x| < 1e5. Reductions rely on the order of differences, which a driver may change: tests
show whether one does.
"""

import math

import taichi as ti
import taichi.math as tm

from engine.device.backend import has_elementary_functions

LOG_2, SQRT_2 = math.log(2.0), math.sqrt(2.0)

LEAST_EXPONENT = -746.0
"""Below it e^x is zero."""

LN2 = (0.6931471806019545, -4.2009150726810846e-11)
"""ln 2 to 32 bits, which any exponent multiplies exactly, and the rest."""

QUARTER_TURN = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
"""pi/2 to 33 bits, the next 33, and the rest."""

ARCSINE_NUMERATOR = (
    *(1.66666666666666657415e-01, -3.25565818622400915405e-01, 2.01212532134862925881e-01),
    *(-4.00555345006794114027e-02, 7.91534994289814532176e-04, 3.47933107596021167570e-05),
)
ARCSINE_DENOMINATOR = (
    *(1.0, -2.40339491173441421878, 2.02094576023350569471),
    *(-6.88283971605453293030e-01, 7.70381505559019352791e-02),
)
"""Of (asin(x)/x - 1)/x^2 in powers of x^2, for |x| <= 1/2 (fdlibm, e_asin.c)."""

EXPONENTIAL = tuple(1.0 / math.factorial(n) for n in range(2, 15))
LOGARITHM = tuple(2.0 / (2 * n + 1) for n in range(1, 12))
SINE = tuple((-1.0) ** n / math.factorial(2 * n + 1) for n in range(1, 10))
COSINE = tuple((-1.0) ** n / math.factorial(2 * n) for n in range(2, 11))
"""Coefficients of Taylor series, from the first term that is not written out."""


@ti.func
def exp(x):
    """Return e^x."""
    result = x
    if ti.static(has_elementary_functions()):
        result = ti.exp(x)
    else:
        n = ti.min(ti.max(ti.floor(x / LOG_2 + 0.5), -2040.0), 2040.0)
        r = (x - n * LN2[0]) - n * LN2[1]
        half = ti.cast(n, ti.i32) // 2
        result = (1.0 + (r + r * r * polynomial(r, EXPONENTIAL))) * power_of_two(half)
        result *= power_of_two(ti.cast(n, ti.i32) - half)
        if x < LEAST_EXPONENT:
            result = 0.0
    return result


@ti.func
def log(x):
    """Return ln x."""
    result = x
    if ti.static(has_elementary_functions()):
        result = ti.log(x)
    elif x > 0.0:
        result = positive_log(x)
    elif x <= 0.0:
        result = -tm.inf if x == 0.0 else tm.nan
    return result


@ti.func
def positive_log(x):
    """Return ln x of a normal positive number x = m 2^n, with f = m - 1."""
    bits = ti.bit_cast(x, ti.i64)
    n = ti.cast((bits >> 52) - 1023, ti.i32)
    m = ti.bit_cast(bits - (ti.cast(n, ti.i64) << 52), ti.f64)
    if m > SQRT_2:
        m, n = 0.5 * m, n + 1
    f = m - 1.0
    s, half_square = f / (2.0 + f), 0.5 * f * f
    tail = s * (half_square + s * s * polynomial(s * s, LOGARITHM))
    return n * LN2[0] - ((half_square - (tail + n * LN2[1])) - f)


@ti.func
def log1p(x):
    """Return ln(1 + x), for small x by the series of artanh(x/(2 + x))."""
    s = x / (2.0 + x)
    result = 2.0 * s + s * s * s * polynomial(s * s, LOGARITHM)
    if ti.abs(x) > 0.3:
        result = log(1.0 + x)
    return result


@ti.func
def expm1(x):
    """Return e^x - 1, for small x by its series."""
    result = x + x * x * polynomial(x, EXPONENTIAL)
    if ti.abs(x) > 0.5:
        result = exp(x) - 1.0
    return result


@ti.func
def cbrt(x):
    """Return the cube root of x."""
    y = power(x, 1.0 / 3.0)
    if ti.static(not has_elementary_functions()):
        y -= (y - x / (y * y)) / 3.0
    return y


@ti.func
def power(x, y):
    """Return x^y."""
    return ti.pow(x, y) if ti.static(has_elementary_functions()) else exp(y * log(x))


@ti.func
def sin(x):
    """Return sin x."""
    return ti.sin(x) if ti.static(has_elementary_functions()) else turned(x, 0)


@ti.func
def cos(x):
    """Return cos x."""
    return ti.cos(x) if ti.static(has_elementary_functions()) else turned(x, 1)


@ti.func
def asin(x):
    """Return the angle from -pi/2 to pi/2 whose sine is x."""
    result = x
    if ti.static(has_elementary_functions()):
        result = ti.asin(x)
    elif ti.abs(x) <= 0.5:
        result = small_arcsine(x)
    else:
        result = 0.5 * math.pi - small_arccosine(ti.abs(x))
        if x < 0.0:
            result = -result
    return result


@ti.func
def acos(x):
    """Return the angle from 0 to pi whose cosine is x."""
    result = x
    if ti.static(has_elementary_functions()):
        result = ti.acos(x)
    elif ti.abs(x) <= 0.5:
        result = 0.5 * math.pi - small_arcsine(x)
    else:
        result = small_arccosine(ti.abs(x))
        if x < 0.0:
            result = math.pi - result
    return result


@ti.func
def turned(x, quarters):
    """Return sin(x + quarters pi/2)."""
    n = ti.floor(x / (0.5 * math.pi) + 0.5)
    r = ((x - n * QUARTER_TURN[0]) - n * QUARTER_TURN[1]) - n * QUARTER_TURN[2]
    quadrant = (ti.cast(n, ti.i32) + quarters) & 3
    result = r + r * r * r * polynomial(r * r, SINE)
    if quadrant & 1 == 1:
        result = 1.0 - (0.5 * r * r - r * r * r * r * polynomial(r * r, COSINE))
    if quadrant & 2 == 2:
        result = -result
    return result


@ti.func
def small_arcsine(x):
    """Return the arcsine of |x| <= 1/2."""
    z = x * x
    return x + x * z * polynomial(z, ARCSINE_NUMERATOR) / polynomial(z, ARCSINE_DENOMINATOR)


@ti.func
def small_arccosine(x):
    """Return the arccosine of x from 1/2 to 1."""
    return 2.0 * small_arcsine(ti.sqrt(0.5 * (1.0 - x)))


@ti.func
def polynomial(x, coefficients: ti.template()):
    """Return the sum of coefficients[n] x^n."""
    result = 0.0 * x + coefficients[-1]
    for n in ti.static(range(len(coefficients) - 2, -1, -1)):
        result = result * x + coefficients[n]
    return result


@ti.func
def power_of_two(n):
    """Return 2^n, |n| <= 1022."""
    return ti.bit_cast(ti.cast(1023 + n, ti.i64) << 52, ti.f64)
