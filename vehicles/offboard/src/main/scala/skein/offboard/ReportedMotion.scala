package skein.offboard

import skein.mavlink.*
import skein.mavlink.CommonDialect.Frame.LocalNed
import skein.signal.Kinematics
import skein.units.*

/** A vehicle's motion as it reports it, in its own frame: by ODOMETRY, or else by LOCAL_POSITION_NED and the
  * newest ATTITUDE_QUATERNION.
  *
  * @param newest the newest state, with its time on the vehicle's clock
  */
final case class ReportedMotion(
    newest: Option[(state: Kinematics, at: Instant)] = None,
    attitude: Option[AttitudeQuaternion] = None,
    hasOdometry: Boolean = false
):
  /** Reads a message.
    *
    * @return the motion, and whether it has a new sample
    */
  def heard(message: Message): (ReportedMotion, Boolean) = message match
    case one: Odometry if one.frameId == LocalNed && one.q.size == 4 =>
      val turn     = Quaternion(one.q(0), one.q(1), one.q(2), one.q(3))
      val told     = Vector3(one.vx, one.vy, one.vz)
      val velocity = if one.childFrameId == LocalNed then told else turn.toWorld(told)
      val state    = Kinematics(
        Vector3(one.x, one.y, one.z),
        velocity,
        turn,
        Vector3(one.rollspeed, one.pitchspeed, one.yawspeed)
      )
      copy(hasOdometry = true).withNewest(state, Instant.ofNanos(one.timeUsec * 1000))
    case one: AttitudeQuaternion               => (copy(attitude = Some(one)), false)
    case one: LocalPositionNed if !hasOdometry =>
      attitude.fold((this, false)): turned =>
        val state = Kinematics(
          Vector3(one.x, one.y, one.z),
          Vector3(one.vx, one.vy, one.vz),
          Quaternion(turned.q1, turned.q2, turned.q3, turned.q4),
          Vector3(turned.rollspeed, turned.pitchspeed, turned.yawspeed)
        )
        // Its time is cut to whole milliseconds.
        withNewest(state, Instant.ofNanos(one.timeBootMs * 1_000_000 + 500_000))
    case _ => (this, false)

  private def withNewest(state: Kinematics, at: Instant): (ReportedMotion, Boolean) =
    def isLater(last: Instant) = at > last || last.since(at) > Restart
    if state.isFinite && newest.forall(one => isLater(one.at)) then
      (copy(newest = Some((state = state, at = at))), true)
    else (this, false)

/** Messages do not overtake by so much: a vehicle's clock that is set back by more has begun anew. */
private val Restart = Span.ofSeconds(1)
