package skein.vehicle

/** A [[StepwiseFlight]] by a [[Plant]]. Mutable. */
final class PlantFlight[S](val plant: Plant[S]) extends StepwiseFlight[S](plant, plant.initial):
  private var wantedNorthMps, wantedEastMps = 0.0

  def reading: PlaneReading = plant.read(state)

  /** Sets the state at a time, s, and the command in effect from then on, m/s. */
  def start(atS: Double, state: S, northMps: Double = 0, eastMps: Double = 0): Unit =
    command(northMps, eastMps)
    begin(atS, state)

  /** Sets the command in effect from a time on, m/s; the caller accounts for dead time. */
  def act(atS: Double, northMps: Double, eastMps: Double): Unit =
    advance(atS)
    command(northMps, eastMps)
    beginStep(atS)

  private def command(northMps: Double, eastMps: Double): Unit =
    wantedNorthMps = northMps; wantedEastMps = eastMps

  protected def stepped(from: S, spanS: Double): S = plant.step(from, wantedNorthMps, wantedEastMps, spanS)
