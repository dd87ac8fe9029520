"""What sensors make of the true quantities: noise, quantisation, delay, dropout."""
