"""Variables of the thesis's own kinds of problems: a worm of another body mass, and the calibration of the worm."""

from __future__ import annotations

from cosserat.solution import Variable, Variables

VARIABLES = Variables(
    variables={
        "stride": Variable((), "m", "stride length", r"\Delta", "2.8.5", 1e-10),
        "speed": Variable((), "m s-1", "stride length over stride duration", "", "2.8.5", 1e-10),
        "frequency": Variable((), "s-1", "strides in unit time", "1/(t_p+t_s)", "2.8", 1e-12),
        "mu_1_least": Variable((), "1", "least vertical stretch of segment 50", r"\mu_1", "1.3.6", 1e-9),
        "mu_1_most": Variable(
            (), "1", "largest vertical stretch of segment 50", r"\mu_1", "1.3.6", 1e-9
        ),
        "mu_3_least": Variable((), "1", "least stretch along segment 50", r"\mu_3", "1.3.6", 1e-9),
        "mu_3_most": Variable((), "1", "largest stretch along segment 50", r"\mu_3", "1.3.6", 1e-9),
        "fitted_young": Variable((), "Pa", "modulus of the worm by the fit", "E", "2.6.17", 1e-4),
        "fitted_anchoring": Variable((), "N", "anchoring force by the fit", r"\bar{D}", "2.2.7", 1e-9),
        "fitted_advancing": Variable((), "Pa", "advancing pressure by the fit", "p", "2.2.8", 1e-4),
        "fitted_outcomes": Variable(
            ("outcome",), "1", "by the fit, over what was measured", "", "2.8.6", 1e-7
        ),
        "given_outcomes": Variable(
            ("outcome",), "1", "by the given worm, over what was measured", "", "2.8.6", 1e-9
        ),
    },
    labels={"outcome": "what the calibration of the worm matches"},
    coordinates=(),
)
