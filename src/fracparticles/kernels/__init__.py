"""The kernels of the schemes: by name and family, of high order, tabulated."""
