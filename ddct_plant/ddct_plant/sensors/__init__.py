"""Sensor models: gain, constant offset, noise, quantisation, delay and dropout."""
