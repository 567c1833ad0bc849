"""pneumorph: soft pneumatic actuators from parameters to inflated shape."""
