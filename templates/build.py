"""Build template workbooks: `python templates/build.py [FOLDER [NAME …]]`.

Without a folder they are built where they are committed, and without names all are.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
if __name__ == "__main__":
    sys.path.append(str(HERE.parent))

# The path above makes a plain `python templates/build.py` work.
from templates import (  # noqa: E402
    airborne,
    collinear,
    critical_speed_yaw,
    crush_energy,
    edr_speed,
    low_speed,
    momentum_energy,
    motorcycle,
    pedestrian,
    pedestrian_throw,
    skid,
    time_distance,
    video_speed,
)
from templates.description import Template  # noqa: E402
from templates.editions import Edition, edition  # noqa: E402
from templates.momentum import describe as momentum  # noqa: E402
from templates.other_fields import beam, mass_calibration, project, tolerance_stack, warranty  # noqa: E402
from templates.planar_forward import describe as planar_forward  # noqa: E402
from templates.planar_impact import describe as planar_impact  # noqa: E402
from templates.two_vehicles.example_scene import EXAMPLE, FORWARD_EXAMPLE, MOMENTUM_EXAMPLE  # noqa: E402
from templates.writer import write_book  # noqa: E402

__all__ = ["TEMPLATES", "build", "editions", "file_name"]

TEMPLATES: dict[str, Template] = {
    "skid": skid.TEMPLATE,
    "critical-speed-yaw": critical_speed_yaw.TEMPLATE,
    "collinear": collinear.TEMPLATE,
    "momentum": momentum(MOMENTUM_EXAMPLE),
    "planar-impact": planar_impact(EXAMPLE),
    "planar-forward": planar_forward(FORWARD_EXAMPLE),
    "crush-energy": crush_energy.TEMPLATE,
    "pedestrian-throw": pedestrian_throw.TEMPLATE,
    "time-distance": time_distance.TEMPLATE,
    "airborne": airborne.TEMPLATE,
    "edr-speed": edr_speed.TEMPLATE,
    "video-speed": video_speed.TEMPLATE,
    "momentum-energy": momentum_energy.TEMPLATE,
    "pedestrian": pedestrian.TEMPLATE,
    "low-speed": low_speed.TEMPLATE,
    "motorcycle": motorcycle.TEMPLATE,
    "beam": beam.TEMPLATE,
    "tolerance-stack": tolerance_stack.TEMPLATE,
    "mass-calibration": mass_calibration.TEMPLATE,
    "project": project.TEMPLATE,
    "warranty": warranty.TEMPLATE,
}
"""Name of the template -> what its workbooks say, both editions in one."""


def file_name(name: str, units: Edition) -> str:
    """The imperial edition has the name of the template; the SI edition, `-si` after it."""
    return f"{name}.xlsx" if units is Edition.IMPERIAL else f"{name}-{units.value}.xlsx"


def editions(template: Template) -> dict[Edition, Template]:
    """The editions of a template; only the imperial one where no unit tells them apart."""
    made = {units: edition(template, units) for units in Edition}
    if made[Edition.IMPERIAL] == made[Edition.SI]:
        del made[Edition.SI]
    return made


def build(folder: Path, names: Sequence[str] = ()) -> list[Path]:
    """Write every edition of the templates, or of those named, into `folder`; the paths written are returned."""
    written = []
    for name in names or TEMPLATES:
        for units, described in editions(TEMPLATES[name]).items():
            path = folder / file_name(name, units)
            write_book(described, path)
            written.append(path)
    return written


if __name__ == "__main__":
    build(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE, sys.argv[2:])
