package skein.vehicle

/** A [[StepwiseFlight]] by a [[SpatialPlant]]. Mutable. */
final class SpatialFlight[S](plant: SpatialPlant[S]) extends StepwiseFlight[S](plant, plant.initial(0)):
  private var north, east, third, holds = 0.0

  def reading: SpaceReading = plant.read(state)

  /** Rests at an altitude, m down. */
  def rest(downM: Double): Unit = begin(0, plant.initial(downM))

  /** Sets the state at a time, s, and the command in effect from then on; for the command see
    * [[SpatialPlant.step]].
    */
  def start(atS: Double, state: S, northMps: Double, eastMps: Double, third: Double, holds: Double): Unit =
    begin(atS, state)
    act(atS, northMps, eastMps, third, holds)

  /** Sets the command in effect from `atS` on; the caller has simulated up to that time. */
  def act(atS: Double, northMps: Double, eastMps: Double, third: Double, holds: Double): Unit =
    north = northMps; east = eastMps
    this.third = third; this.holds = holds
    beginStep(atS)

  protected def stepped(from: S, spanS: Double): S = plant.step(from, north, east, third, holds, spanS)
