# The way with apt's ROS 2 Jazzy, as docs/use/setup.md has it. From the root of the repository:
#     docker build -f containers/apt.Dockerfile -t ddct-apt .
#     docker run --rm ddct-apt
FROM ros:jazzy-ros-base
SHELL ["/bin/bash", "-c"]
# pip brings what has no rosdep key, and rosdep itself calls it for keys that end in -pip: the
# variable lets both put packages beside those of apt.
ENV PIP_BREAK_SYSTEM_PACKAGES=1
RUN apt-get update && apt-get install -y --no-install-recommends python3-pip \
    && pip install cloudpickle daqp mcap osqp portalocker pyarrow rosbags threadpoolctl \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /ddct
COPY . .
RUN apt-get update && . /opt/ros/jazzy/setup.bash \
    && rosdep update && rosdep install -y --from-paths ddct_plant ddct_reference ddct_controllers ddct_bringup \
    --ignore-src && colcon build && rm -rf /var/lib/apt/lists/*
CMD ["bash", "-c", ". install/setup.bash && ddct compare --controllers pi,ls8,hinf1 --out runs/apt --overwrite"]
