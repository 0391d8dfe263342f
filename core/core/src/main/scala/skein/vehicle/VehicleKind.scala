package skein.vehicle

/** What sort of vehicle an agent of a scenario is. */
enum VehicleKind:
  /** AirSim's quadrotor, which flies in three dimensions. */
  case Multirotor

  /** A car on wheels, which stays on the ground and can neither turn on the spot nor move sideways. */
  case Car
