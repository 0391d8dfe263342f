package skein.lanes

import skein.vehicle.{ObservedPlant, PlaneReading}

final case class OnRails(northM: Double, northMps: Double)

/** A vehicle that moves north and south only, whatever the command. The product does not contain this plant.
  */
final case class Train(lagS: Double) extends ObservedPlant[OnRails]:
  def initial: OnRails                   = OnRails(0, 0)
  def stepS: Double                      = 0.04
  def read(state: OnRails): PlaneReading = PlaneReading(state.northM, 0, state.northMps, 0)
  def corrected(state: OnRails, seen: PlaneReading): OnRails = OnRails(seen.northM, seen.northMps)

  def step(state: OnRails, northMps: Double, eastMps: Double, dtS: Double): OnRails =
    val speed = northMps + (state.northMps - northMps) * StrictMath.exp(-dtS / lagS)
    OnRails(state.northM + speed * dtS, speed)
