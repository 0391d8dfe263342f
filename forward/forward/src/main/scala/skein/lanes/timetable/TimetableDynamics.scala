package skein.lanes.timetable

import skein.forward.RolloutAgent
import skein.vehicle.SensorNoise

/** Simulates a kind of vehicle by [[Timetable]]s. */
private[skein] trait TimetableDynamics:
  /** Time from a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double

  /** See [[skein.forward.VelocityResponse.handoverS]]. */
  def handoverS: Double

  /** Errors of the vehicles' readings, if they have any. */
  def sensors: Option[SensorNoise] = None

  def clock(): EventClock

  /** The vehicles with one index in all worlds; the caller sets what differs between worlds.
    *
    * @param agent the vehicle; its speed is that of a direction of length 1
    */
  def vehicles(agent: RolloutAgent): TimetableVehicles

  /** The model that predicts the vehicles from their readings; None in loops that do not predict. */
  def predictor: Option[TimetablePredictor] = None
