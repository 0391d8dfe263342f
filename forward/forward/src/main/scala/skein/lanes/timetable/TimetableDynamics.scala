package skein.lanes.timetable

import skein.forward.RolloutAgent

/** How a kind of vehicle flies by [[Timetable]]s. */
private[skein] trait TimetableDynamics:
  /** From a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double

  /** [[skein.forward.VelocityResponse.handoverS]]. */
  def handoverS: Double

  /** Of one vehicle in one episode. */
  def clock(): EventClock

  /** All worlds' vehicles of one number; what differs between worlds is told to them.
    *
    * @param agent its speed is that of a direction of length 1
    */
  def vehicles(agent: RolloutAgent): TimetableVehicles

  /** What carries their readings forward, in loops that predict. */
  def predictor: Option[TimetablePredictor] = None
