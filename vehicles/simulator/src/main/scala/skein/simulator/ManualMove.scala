package skein.simulator

import skein.airsim.wire.{RcData, YawMode}
import skein.units.*
import skein.vehicle.Setpoint

/** Flies in the direction of the remote control's sticks, in the frame that the vehicle had at the start
  * (`MultirotorApiBase::moveByManual`). Sticks that are not valid set no goal.
  */
final private[simulator] class ManualMove private (
    speedX: Double,
    speedY: Double,
    down: Double,
    duration: Span,
    drivetrain: Int,
    yaw: YawMode,
    start: Quaternion
) extends Move:
  import ManualMove.*

  override def lastsAtLeast: Span = duration

  def turn(vehicle: SimulatedMultirotor, elapsed: Span): MoveProgress =
    val goal = Option.when(vehicle.sticks.is_valid)(towards(vehicle.sticks, vehicle.state.z))
    if elapsed >= duration then MoveProgress.Ended(true, goal)
    else goal.fold(MoveProgress.Idle)(MoveProgress.Going(_))

  private def towards(sticks: RcData, z: Double): Setpoint =
    val wanted   = Vector3(sticks.pitch * speedY / FullStick, sticks.roll * speedX / FullStick, 0)
    val velocity = start.toBody(wanted)
    val turned   = yaw.copy(yaw_or_rate = yaw.yaw_or_rate + sticks.yaw * 100 / FullStick)
    Move.withYaw(
      Setpoint.velocityZ(velocity.x, velocity.y, z + sticks.throttle / FullStick * down),
      Move.facing(drivetrain, turned, velocity)
    )

private[simulator] object ManualMove:
  /** The value that AirSim takes as full deflection. */
  private val FullStick = 10000f

  def order(
      speedX: Float,
      speedY: Float,
      down: Float,
      seconds: Float,
      drivetrain: Int,
      yaw: YawMode
  ): Move.Order =
    vehicle =>
      Right(ManualMove(speedX, speedY, down, Move.span(seconds), drivetrain, yaw, vehicle.state.orientation))
