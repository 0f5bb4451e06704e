"""The kernels of the schemes: by name and kernel family, printed, of high order, tabulated."""
