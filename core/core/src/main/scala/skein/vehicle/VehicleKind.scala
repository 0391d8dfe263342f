package skein.vehicle

/** The kind of vehicle that a scenario's agent controls. */
enum VehicleKind:
  /** AirSim's quadrotor, which flies in three dimensions. */
  case Multirotor

  /** A car on wheels, which stays on the ground and can neither turn on the spot nor move sideways. */
  case Car
