"""The paper's own formulation: related joints, offset points, fitted boundary."""
