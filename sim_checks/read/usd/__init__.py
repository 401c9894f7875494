"""USD assets with physics joints, as the URDF that says the same: no engine here reads USD."""
