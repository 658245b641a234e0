"""The guide sheet."""

from __future__ import annotations

from templates.braking import NO_BRAKING
from templates.description import GuideSection
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS

__all__ = ["GUIDE"]

GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle on its way, and an intruder that crosses its path: a left turn, a pull-out, a pedestrian. It "
            "answers how fast the vehicle was before it braked, how long its driver took to respond, and whether the "
            "crash would have been avoided at another speed, by stopping or because the intruder had cleared.",
            "A pedestrian: set the acceleration to 0 and Frozen to TRUE, enter the walking speed as the intruder's "
            "speed, with its range, and set its Frozen to FALSE.",
            "The speed at the impact comes from another model (momentum, crush-energy, pedestrian-throw) or from an "
            "EDR (edr-speed). xlmc simulate --feed carries its trials through this workbook, one by one (docs, Books "
            "in a chain). A mean and a standard deviation would lose what that speed goes together with, such as the "
            "friction of a shared road.",
            "Not where the vehicle braked in parts, steered, or was itself accelerating.",
        ),
    ),
    GuideSection(
        "Two drivers, two questions",
        (
            "Same driver: would this crash have been avoided, had this driver been at the speed in question and "
            "responded as here? The response time that the crash implies is kept. This shows what the speed alone "
            "changed.",
            "Ordinary driver: would a driver drawn from the published distribution have avoided it from there? Another "
            "question, with another answer, often a very different one. Say which one you answer.",
            "The implied response time is evidence: below 0.5 s nobody responds, and a filter rejects it. The row on "
            "sheet Evidence weighs it by the published distribution of response times, if you set Use to TRUE; it has "
            "no effect without braking. Do so only if nothing else in the workbook already uses that distribution for "
            "this driver.",
            "Where the vehicle was no faster than the speed in question, that speed would not have helped: the same "
            "driver has then not avoided it. See how often it was above the limit.",
            "Yes and no (1 and 0): the mean is the probability of a yes.",
        ),
    ),
    NO_BRAKING,
    GuideSection(
        "Published values",
        ("A constant acceleration is for the first [30 ft|10 m] or so: it falls as speed grows.",),
        (
            ("Quantity", "Values"),
            ("Response to brake lights, surprise", "mean 1.25 s, SD 0.46 s"),
            (
                "Green's review of such times (Transportation Human Factors 2(3), 2000)",
                "brake lights ahead about 1.25 s; an object that suddenly moves into the path roughly 1.5 s",
            ),
            (
                "A barrel that rolls toward the path, drivers unaware (HFES Proceedings 37, 1993, page 206)",
                "mean 1.5 s, 85th percentile 1.9 s, at all ages alike",
            ),
            (
                "Of drivers who braked in 122 events of left turns across the path",
                "100, 99, 90, 58, 30 % reached .4, .5, .6, .7, .8 g (SAE 2019-01-0414, tallied by Peck)",
            ),
            ("Cars starting from rest, comfortable", ".15 to .20 g"),
            (
                "Walking, older than 65 years",
                "mean [3.81 ft/s = 2.60 mph|1.16 m/s = 4.18 km/h], 15th percentile [3.02 ft/s = 2.06 mph|0.92 m/s = "
                "3.31 km/h] (Gates and others, TRB 06-1826)",
            ),
        ),
    ),
    CAVEATS,
)
