"""Wrong arguments: one clear error each, before anything is loaded."""

import pytest

from asset_factory.envs.tasks import arguments
from asset_factory.factory.errors import ConfigError


@pytest.mark.parametrize("backend", ["physx_cpu", "cpu"])
def test_several_environments_on_a_cpu_are_sent_to_processes(backend):
    told = r"num_envs must be 1 .*not 2.*make_processes.*AsyncVectorEnv"
    with pytest.raises(ConfigError, match=told):
        arguments.check_number("OpenJointEnv", 2, backend)
    assert arguments.check_number("OpenJointEnv", 1, backend) is False


def test_several_environments_without_a_gpu_are_told_so():
    torch = pytest.importorskip("torch", reason="torch is not installed")
    if torch.cuda.is_available():
        assert arguments.check_number("OpenJointEnv", 2, "auto") is True
        return
    with pytest.raises(ConfigError, match="there is no CUDA device; want num_envs=1"):
        arguments.check_number("OpenJointEnv", 2, "auto")


@pytest.mark.parametrize("bounds", [(2.0, 1.0), (-1.0, 1.0), (0.0, float("inf"))])
def test_a_range_that_is_none_and_a_share_beyond_it_are_refused(bounds):
    with pytest.raises(ConfigError, match="friction_range must be"):
        arguments.check_range("OpenJointEnv", "friction_range", bounds)
    with pytest.raises(ConfigError, match=r"goal must be a share"):
        arguments.check_share("SetJointEnv", "goal", 1.5)


@pytest.mark.parametrize(
    ("obs_mode", "render_mode", "backend", "chosen"),
    [
        ("state", None, "auto", "none"),
        ("state_dict", None, "auto", "none"),
        ("rgbd", None, "auto", "gpu"),
        ("state", "rgb_array", "auto", "gpu"),
        ("pointcloud", None, "cpu", "cpu"),
        ("state", None, None, "none"),
    ],
)
def test_a_renderer_is_only_asked_for_where_pictures_are(obs_mode, render_mode, backend, chosen):
    assert arguments.choose_renderer("OpenJointEnv", obs_mode, render_mode, backend) == chosen


def test_joint_types_of_user_and_task_are_intersected():
    assert arguments.common_types("t", (), ("prismatic",)) == ("prismatic",)
    assert arguments.common_types("t", ("prismatic", "revolute"), ("prismatic",)) == ("prismatic",)
    assert arguments.common_types("t", ("revolute",), ()) == ("revolute",)
