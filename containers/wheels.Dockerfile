# The way with make: ROS 2 from wheels. From the root of the repository:
#     docker build -f containers/wheels.Dockerfile -t ddct-wheels .
#     docker run --rm ddct-wheels make demo
FROM python:3.12-slim-bookworm
# make for the two commands, git for the tests that list files, gcc for controllers in C, chromium for the pages.
RUN apt-get update && apt-get install -y --no-install-recommends make git gcc libc6-dev chromium \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /ddct
COPY . .
RUN make setup
CMD ["make", "test"]
