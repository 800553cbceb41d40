"""Import of a dataset's folder: everything is read and checked before the first row is written.

`dataset.import_dataset` is the only way in; the demo scene takes it too.
"""
