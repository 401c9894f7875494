"""What the cameras see where there is Vulkan, and what is said where there is none."""

from making import make
from openable_samples import cabinet, write_registry

from asset_factory.factory.errors import ConfigError
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated


def pictures(registry):
    """Runs in a child: what the task's camera sees, or why it sees nothing."""
    try:
        env = make(registry, asset="cabinet", obs_mode="rgbd", render_mode="rgb_array")
    except ConfigError as error:
        return str(error)
    observation, _ = env.reset(seed=0)
    return observation["sensor_data"]["base_camera"]["rgb"][0].numpy(), env.render()[0].numpy()


def test_the_cameras_see_the_red_cabinet_or_vulkan_is_asked_for(tmp_path):
    registry = write_registry(tmp_path, cabinet())
    seen = run_isolated(pictures, registry, limits=Limits(wall_s=300.0)).unwrap()
    if isinstance(seen, str):
        assert "OpenJointEnv: obs_mode 'rgbd' needs Vulkan, and none was found" in seen
        assert "mesa-vulkan-drivers" in seen
        assert "obs_mode 'state' without render_mode works without" in seen
        return
    for image in seen:
        red = (image[..., 0] > 80) & (image[..., 1] < 60) & (image[..., 2] < 60)
        assert red.mean() > 0.03
