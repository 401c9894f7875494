"""Numbers that are not finite give a verdict, never a traceback: on paper and in any engine."""

import pytest
from small_cabinet import write_urdf

from asset_factory.sim_checks import Status

ENGINES = ("sapien", "mujoco", "pybullet")
LIMIT = '<limit lower="0.0" upper="0.3"'


@pytest.fixture(autouse=True)
def there():
    for engine in ENGINES:
        pytest.importorskip(engine)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ('<mass value="3.0"/>', '<mass value="inf"/>', "inertia_not_finite"),
        ('<mass value="3.0"/>', '<mass value="nan"/>', "inertia_not_finite"),
        ('ixx="0.0', 'ixx="nan" was="0.0', "inertia_not_finite"),
        (LIMIT, f'<mimic joint="hinge" multiplier="inf"/>{LIMIT}', "mimic_not_finite"),
        (LIMIT, f'<mimic joint="hinge" offset="1e300"/>{LIMIT}', "mimic_not_finite"),
        (LIMIT, '<limit lower="0" upper="inf"', "limits_not_finite"),
        (LIMIT, '<limit lower="0" upper="1e9"', "range_implausible"),
    ],
)
def test_a_number_that_is_none_is_a_verdict(tmp_path, judge, old, new, code):
    report = judge.check(write_urdf(tmp_path, replace={old: new}), ENGINES)
    assert report.errors[0].code == code
    assert report.status is not Status.UNJUDGED
    assert code in report.to_json()
