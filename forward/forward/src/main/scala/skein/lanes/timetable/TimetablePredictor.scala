package skein.lanes.timetable

import skein.forward.RolloutAgent

/** A kind of model that predicts by [[Timetable]]s. */
private[skein] trait TimetablePredictor:
  def propagator: Propagator

  def vehicles(agent: RolloutAgent): PredictedVehicles

  /** Whether its state holds more than a reading. */
  def remembers: Boolean = false

  /** From a command's arrival until a vehicle is assumed to follow it, s. */
  def deadTimeS: Double
