package skein.lanes.timetable

import skein.forward.RolloutAgent

/** A kind of model that [[Timetable]]s use for predictions. */
private[skein] trait TimetablePredictor:
  def propagator: Propagator

  def vehicles(agent: RolloutAgent): PredictedVehicles

  /** Whether the model's state contains more than a reading, such as the altitude that it holds at first. */
  def remembers: Boolean = false

  /** Time from a command's arrival until a vehicle is assumed to follow it, s. */
  def deadTimeS: Double
