package skein.vehicle

/** A car with a driver model that follows commanded velocities. */
final case class DrivenCar(
    car: SingleTrack = SingleTrack(),
    driver: CarDriver = CarDriver(),
    startHeadingRad: Double = 0
) extends Plant[CarState]:
  def initial: CarState = CarState(0, 0, startHeadingRad)
  def stepS: Double     = 0.01

  def step(state: CarState, northMps: Double, eastMps: Double, dtS: Double): CarState =
    car.step(state, driver.controls(car, state.headingRad, state.frontMps, northMps, eastMps), dtS)

  def read(state: CarState): PlaneReading =
    PlaneReading(state.northM, state.eastM, state.northMps, state.eastMps)
