"""Read and write files of users: bounded in size, written completely or not at all."""
