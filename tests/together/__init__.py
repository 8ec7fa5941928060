"""Both solvers on one scene."""
