"""What a scene may say: bodies, materials, parts of physics, resolution; no Taichi."""
