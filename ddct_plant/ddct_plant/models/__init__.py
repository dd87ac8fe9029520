"""Models of engine, load, clutch, driveline, vehicle and actuator; no ROS, no clock."""
