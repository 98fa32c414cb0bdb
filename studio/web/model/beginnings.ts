/** The ways to begin a project: the answers to two questions lead to an example, or to a first specification. */

export const robots = ["mobile", "arm", "several", "nothing"] as const;
export type Robot = (typeof robots)[number];
export const worlds = ["simulated", "ros2"] as const;
export type World = (typeof worlds)[number];

export const robotTitles: Record<Robot, { title: string; text: string }> = {
  mobile: { title: "A mobile robot", text: "wheels, sensors, a place to go to" },
  arm: { title: "A robot arm", text: "joints, and poses to reach" },
  several: { title: "Several robots", text: "agents that talk to each other" },
  nothing: { title: "Not known yet", text: "one empty agent, to be built by hand" },
};

export const worldTitles: Record<World, { title: string; text: string }> = {
  simulated: { title: "Simulated", text: "in a physics world that comes with it" },
  ros2: { title: "Real, with ROS 2", text: "topics and actions of your robot" },
};

/** A copy of an example with its C++ and its world, or a specification whose functions are not written yet. */
export type Beginning = { example: string; says: string } | { specification: (system: string) => string; says: string };

/** The beginning for two answers. */
export function beginningOf(robot: Robot, world: World): Beginning {
  return table[robot][world];
}

const head = (system: string) => `tessera: 1\nsystem: ${system}\n`;

const empty = (system: string) => `${head(system)}agents:
  robot:
    control:
      rate: 10 Hz
      behaviours:
        run: {}
`;

const arm = (system: string) => `${head(system)}
types:
  Joints: { base: float64 rad, shoulder: float64 rad, elbow: float64 rad }
  Speeds: { base: float64 rad/s, shoulder: float64 rad/s, elbow: float64 rad/s }

agents:
  arm:
    control:
      rate: 50 Hz
      inputs:  { joints: Joints }
      outputs: { speeds: Speeds }
      on_error: rest
      memory:  { there: bool }                        # the joints are where the behaviour wants them
      behaviours:
        rest: { terminal: elapsed > 2 s, next: reach }
        reach: { terminal: memory.there, next: rest }
    receptors:
      encoders:
        rate:    50 Hz
        real:    { angles: "float64[3]" }
        outputs: { joints: Joints }
        behaviours: { measure: { next: { to: measure, when: error } } }
    effectors:
      motors:
        rate:   50 Hz
        inputs: { speeds: Speeds }
        real:   { command: "float64[3]" }             # its safe command is zero: the arm stands still
        stale:  300 ms
        behaviours: { move: { next: { to: move, when: error } } }

channels:
  - arm.encoders.joints -> arm.control.joints
  - arm.control.speeds -> arm.motors.speeds

drivers:                                              # the names of your joints, and the topics of your controller
  arm.encoders.angles:
    ros2: /joint_states
    type: sensor_msgs/msg/JointState
    fields: position
    names: [base, shoulder, elbow]
  arm.motors.command: { ros2: /velocity_controller/commands, type: std_msgs/msg/Float64MultiArray }
`;

const several = (system: string) => `${head(system)}
types:
  Twist: { linear: float64 m/s, angular: float64 rad/s }
  Place: { x: float64 m, y: float64 m }

templates:
  carrier:
    control:
      rate: 20 Hz
      inputs:  { place: Place, grant: bool }
      outputs: { motion: Twist, request: bool }
      on_error: wait
      behaviours:
        wait:  { terminal: in.grant, next: drive }    # until the crossing is free
        drive: { terminal: "!in.grant", next: wait }
    receptors:
      odometry:
        rate:    20 Hz
        real:    { odom: Place }
        outputs: { place: Place }
        behaviours: { measure: { next: { to: measure, when: error } } }
    effectors:
      base:
        rate:   20 Hz
        inputs: { motion: Twist }
        real:   { command: Twist }
        stale:  300 ms
        behaviours: { drive: { next: { to: drive, when: error } } }

agents:
  north: { use: carrier }
  south: { use: carrier }
  crossing:                                           # lets one of them pass at a time
    control:
      rate: 10 Hz
      inputs:  { north: bool, south: bool }
      outputs: { to_north: bool, to_south: bool }
      behaviours:
        decide: {}

channels:
  - north.odometry.place -> north.control.place
  - north.control.motion -> north.base.motion
  - north.control.request -> crossing.control.north
  - crossing.control.to_north -> north.control.grant
  - south.odometry.place -> south.control.place
  - south.control.motion -> south.base.motion
  - south.control.request -> crossing.control.south
  - crossing.control.to_south -> south.control.grant

drivers:                                              # the topics of your robots
  north.odometry.odom:
    ros2: /north/odom
    type: nav_msgs/msg/Odometry
    fields: { pose.pose.position.x: x, pose.pose.position.y: y }
  north.base.command:
    ros2: /north/cmd_vel
    type: geometry_msgs/msg/Twist
    fields: { linear.x: linear, angular.z: angular }
  south.odometry.odom:
    ros2: /south/odom
    type: nav_msgs/msg/Odometry
    fields: { pose.pose.position.x: x, pose.pose.position.y: y }
  south.base.command:
    ros2: /south/cmd_vel
    type: geometry_msgs/msg/Twist
    fields: { linear.x: linear, angular.z: angular }
`;

const begunEmpty: Beginning = { specification: empty, says: "A system with one agent and one behaviour." };

const table: Record<Robot, Record<World, Beginning>> = {
  mobile: {
    simulated: { example: "08_rover", says: "A rover with a laser drives about in a room and touches nothing." },
    ros2: { example: "10_patrol", says: "A robot with Nav2 patrols three stations and charges in time." },
  },
  arm: {
    simulated: { example: "09_arm", says: "An arm of three joints moves its hand over a wall and back." },
    ros2: {
      specification: arm,
      says: "An arm of three joints that hears /joint_states and commands speeds. You write its functions.",
    },
  },
  several: {
    simulated: { example: "05_depot", says: "Carriers work around a dock and charge at it, one at a time." },
    ros2: {
      specification: several,
      says: "Two robots with odometry and velocity topics, and a crossing that lets one pass. You write the functions.",
    },
  },
  nothing: { simulated: begunEmpty, ros2: begunEmpty },
};
