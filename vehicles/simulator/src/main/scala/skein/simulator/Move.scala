package skein.simulator

import skein.airsim.wire.YawMode
import skein.units.*
import skein.vehicle.{PathFollowing, Setpoint}

/** A move in progress. AirSim's calls loop every 20 ms of simulated time: they read the vehicle's state,
  * renew its goal, and end when done or when their time has elapsed (`MultirotorApiBase`).
  */
private[simulator] trait Move:
  /** Runs one iteration of AirSim's loop.
    *
    * @param elapsed time since the move began; zero in the first iteration
    */
  def turn(vehicle: SimulatedMultirotor, elapsed: Span): MoveProgress

  /** A lower bound on the move's duration. */
  def lastsAtLeast: Span = Span.Zero

private[simulator] enum MoveProgress:
  case Going(goal: Setpoint)

  /** The move continues and keeps the goal as it is. */
  case Idle

  /** The move has ended and its call answers `result`; a `goal` holds for another 60 ms. */
  case Ended(result: Boolean, goal: Option[Setpoint])

  /** Commands the goal, if there is one; returns the result of a move that has ended. */
  def performed(vehicle: SimulatedMultirotor, at: Instant): Option[Boolean] = this match
    case Going(goal) =>
      vehicle.command(goal, at)
      None
    case Idle                => None
    case Ended(result, goal) =>
      goal.foreach(vehicle.command(_, at))
      Some(result)

private[simulator] object Move:
  /** A requested move, which is made from the vehicle's state when its turn comes. `Left` is the text of the
    * exception that AirSim throws.
    */
  type Order = SimulatedMultirotor => Either[String, Move]

  type Plan = Vector[(at: Instant, action: Order)]

  /** Keeps one goal for a duration. A duration of zero ends immediately with `ifNone`. */
  def hold(seconds: Float, ifNone: Boolean = true)(goal: SimulatedMultirotor => Setpoint): Order = vehicle =>
    val setpoint = goal(vehicle)
    val duration = span(seconds)
    Right(new Move:
      override def lastsAtLeast: Span = duration

      def turn(vehicle: SimulatedMultirotor, elapsed: Span): MoveProgress =
        if duration <= Span.Zero then MoveProgress.Ended(ifNone, None)
        else if elapsed >= duration then MoveProgress.Ended(true, Some(setpoint))
        else MoveProgress.Going(setpoint))

  /** Descends at 0.2 m/s until it has not descended for eleven iterations. */
  def land(timeoutS: Float): Order = _ =>
    var still = 0
    val sink  = Setpoint.velocity(0, 0, 0.2)
    Right: (vehicle, elapsed) =>
      still = if vehicle.state.vz <= ApproximatelyZeroMps then still + 1 else 0
      if still > 10 then MoveProgress.Ended(true, Some(sink))
      else if elapsed >= span(timeoutS) then MoveProgress.Ended(false, Some(sink))
      else MoveProgress.Going(sink)

  /** Turns in place to a heading, then stops turning. */
  def rotate(yawDeg: Float, timeoutS: Float, marginDeg: Float): Order = start =>
    val goal   = Setpoint.hold(start.state.positionNed)
    val target = normalized(yawDeg)
    Right: (vehicle, elapsed) =>
      val there = math.abs(math.toDegrees(vehicle.state.yawRad) - target) <= marginDeg
      val next  = if there then goal else goal.withYaw(math.toRadians(target))
      if timeoutS <= 0 then MoveProgress.Ended(true, None)
      else if there && math.abs(vehicle.state.wz) <= 0.01 then MoveProgress.Ended(true, Some(next))
      else if elapsed >= span(timeoutS) then MoveProgress.Ended(false, Some(next))
      else MoveProgress.Going(next)

  /** A goal with a yaw or yaw rate in degrees. */
  def withYaw(goal: Setpoint, yaw: YawMode): Setpoint =
    val radians = math.toRadians(yaw.yaw_or_rate)
    if yaw.is_rate then goal.withYawRate(radians) else goal.withYaw(radians)

  /** The yaw mode towards the direction of travel, if the drivetrain requires it. */
  def facing(drivetrain: Int, yaw: YawMode, travelNed: Vector3): YawMode =
    if drivetrain != ForwardOnly || yaw.is_rate then yaw
    else if travelNed.norm <= PathFollowing.DistanceAccuracyM then YawMode.Still
    else
      YawMode(
        false,
        normalized(yaw.yaw_or_rate + math.toDegrees(StrictMath.atan2(travelNed.y, travelNed.x)).toFloat)
      )

  val ForwardOnly = 1

  val ApproximatelyZeroMps = 0.05

  /** Converts seconds to a span of at most three years: AirSim's "no limit" is the greatest 32-bit float,
    * more than nanoseconds can count.
    */
  def span(seconds: Float): Span = Span.ofSeconds(math.min(seconds.toDouble, 1e8))

  /** Degrees normalised to −180 to 180. */
  def normalized(degrees: Float): Float =
    val within = degrees % 360
    if within > 180 then within - 360 else if within < -180 then within + 360 else within
