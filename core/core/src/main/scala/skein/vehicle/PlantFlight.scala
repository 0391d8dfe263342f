package skein.vehicle

import skein.units.OwnFailure

/** A vehicle simulated by a [[Plant]], from one event to the next. Mutable. How its time is cut into calls of
  * [[advance]] does not change the flight, but for rounding. An exception in the plant's step becomes an
  * [[skein.units.OwnFailure]].
  */
final class PlantFlight[S](val plant: Plant[S]):
  private var wantedNorthMps, wantedEastMps = 0.0
  private var stepAtS                       = 0.0
  private var from                          = plant.initial // when the present step began
  private var now                           = from

  def state: S              = now
  def reading: PlaneReading = plant.read(now)

  /** Sets its state; the command given here, m/s, is in effect from the start. */
  def start(atS: Double, state: S, northMps: Double = 0, eastMps: Double = 0): Unit =
    now = state
    command(atS, northMps, eastMps)

  /** Sets the command in effect from now on, m/s; the caller accounts for dead time. */
  def act(atS: Double, northMps: Double, eastMps: Double): Unit =
    advance(atS)
    command(atS, northMps, eastMps)

  /** Simulates until this time, s; times must not decrease. */
  def advance(untilS: Double): Unit =
    while untilS > stepAtS + plant.stepS do
      fly(plant.stepS)
      beginStep(stepAtS + plant.stepS)
    if untilS > stepAtS then fly(untilS - stepAtS)

  private def command(atS: Double, northMps: Double, eastMps: Double): Unit =
    wantedNorthMps = northMps; wantedEastMps = eastMps
    beginStep(atS)

  private def beginStep(atS: Double): Unit =
    stepAtS = atS
    from = now

  private def fly(spanS: Double): Unit =
    now = OwnFailure.told(OwnFailure.named("plant", plant)):
      plant.step(from, wantedNorthMps, wantedEastMps, spanS)
