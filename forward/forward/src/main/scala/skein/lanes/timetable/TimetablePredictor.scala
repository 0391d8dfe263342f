package skein.lanes.timetable

import skein.forward.RolloutAgent

/** A kind of model that carries readings forward by [[Timetable]]s. */
private[skein] trait TimetablePredictor:
  /** Of one vehicle at its first reading. */
  def propagator: Propagator

  /** All worlds' predictions of one vehicle. */
  def vehicles(agent: RolloutAgent): PredictedVehicles

  /** Whether readings do not tell all that is known of a vehicle. */
  def remembers: Boolean = false

  /** From a command's arrival until a vehicle is taken to follow it, s. */
  def deadTimeS: Double
