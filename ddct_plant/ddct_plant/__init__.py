"""Plant of the dual dry clutch transmission: engine, load, clutch, driveline, actuator."""
