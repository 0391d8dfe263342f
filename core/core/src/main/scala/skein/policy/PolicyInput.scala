package skein.policy

/** The meaning of an input of a [[PolicyFormula]]. */
enum PolicyInput:
  /** Estimated position of a vehicle, m.
    *
    * @param axis 0 north, 1 east, 2 down
    */
  case Position(vehicle: Int, axis: Int)

  case Velocity(vehicle: Int, axis: Int)

  case Heading(vehicle: Int)

  /** Age of the reading on which a vehicle's estimate is based, s. */
  case Age(vehicle: Int)

  case Elapsed

  case ActsIn

  case Time

  case Cruise

  case StartDown

  case Memory(number: Int)
