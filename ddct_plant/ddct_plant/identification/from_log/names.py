"""What `identify` calls the signals of a log."""

TORQUES = ('engine_torque', 'clutch_torque')
LOAD = 'load_torque'
