package skein.policy

import skein.units.*

/** Steers with another policy, and points its camera at the opponent. With a sensor, the estimate of
  * [[skein.scenario.Eye]] is its only knowledge of the opponent. If the vehicle's own position is predicted,
  * the estimate is predicted for that moment too, with constant velocity; otherwise it is used as of the
  * exposure. Before the first detection, the opponent is assumed to be at its start.
  *
  * @param steers the other policy; receives the estimate instead of readings
  * @param sensor the sensor's name; None if readings of the opponent are used
  */
final case class CameraPursuer(steers: HeadingPolicy, sensor: Option[String], opponentStartNed: Vector3)
    extends Policy.Memoryless:

  override def sensors: Set[String] = sensor.toSet

  def action(seen: Observation): Action =
    val own           = seen.own.kinematics
    val (place, goes) = opponent(seen)
    val towards       = place - own.positionNed
    val closing       = goes - own.velocityNed
    val heading       = steers.heading(
      towards.x,
      towards.y,
      closing.x,
      closing.y,
      seen.headings(seen.self).value,
      StrictMath.atan2(goes.y, goes.x),
      seen.elapsed.toSeconds
    )
    val speed = seen.cruise.value
    val yaw   = Yaw.Towards(Radians(StrictMath.atan2(towards.y, towards.x)))
    Action.VelocityAt(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading), seen.startDown, yaw)

  private def opponent(seen: Observation): (Vector3, Vector3) = sensor match
    case None =>
      val told = seen.vehicles(seen.opponent).kinematics
      (told.positionNed, told.velocityNed)
    case Some(name) =>
      seen.sensed
        .get(name)
        .fold((opponentStartNed, Vector3.Zero)): believed =>
          val value = believed.values
          val moved = Vector3(value(3), value(4), value(5))
          val place = Vector3(value(0), value(1), value(2))
          val ahead = Option.when(seen.own.isPredicted)((believed.age + seen.actsIn).toSeconds)
          (CameraPursuer.carried(place, moved, ahead), moved)

object CameraPursuer:
  /** Longest time for which an estimate is predicted, s; an older estimate is predicted for this time only.
    */
  private val FarthestS = 1.5

  /** Position, m, assumed for an object with this estimated position and velocity, m/s.
    *
    * @param aheadS time from the estimate until the present decision takes effect; None if the vehicle's own
    *   position is not predicted either
    */
  private[skein] def carried(placeNed: Vector3, velocityNed: Vector3, aheadS: Option[Double]): Vector3 =
    placeNed + velocityNed * aheadS.fold(0.0)(carriedS)

  /** The part of this time, s, for which an estimate is predicted. */
  private[skein] def carriedS(aheadS: Double): Double = aheadS.min(FarthestS)
