"""What all pages share: who may see them, texts and modules of the workbench."""
