"""What the workbench asks for: scene, frames, pictures, tutorial."""
