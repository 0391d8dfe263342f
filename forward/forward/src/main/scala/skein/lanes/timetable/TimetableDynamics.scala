package skein.lanes.timetable

import skein.forward.RolloutAgent

/** How [[Timetable]]s simulate a kind of vehicle. */
private[skein] trait TimetableDynamics:
  /** From a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double

  /** See [[skein.forward.VelocityResponse.handoverS]]. */
  def handoverS: Double

  def clock(): EventClock

  /** All worlds' vehicles of one number; differences between worlds are set on them.
    *
    * @param agent its speed is that of a direction of length 1
    */
  def vehicles(agent: RolloutAgent): TimetableVehicles

  /** The model that predicts from their readings, in loops that predict. */
  def predictor: Option[TimetablePredictor] = None
