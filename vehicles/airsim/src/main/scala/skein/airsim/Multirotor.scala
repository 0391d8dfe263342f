package skein.airsim

import scala.concurrent.Future
import skein.airsim.wire.*
import skein.policy.{Action, Yaw}
import skein.port.CommandPlan
import skein.rpc.RpcError
import skein.signal.Stamped
import skein.units.*
import upack.{Arr, Bool, Float64, Int32, Int64, Msg, Str}
import upickle.default.writeMsg

/** One multirotor of a simulator. Positions are world NED in m, velocities NED in m/s.
  *
  * A move answers when it has ended: true if it was completed, false if a newer one replaced it or its time
  * was over. All moves of one vehicle share a connection and stay in order. AirSim holds a worker for each
  * move until it ends, so have at most one in progress and one that replaces it.
  */
final class Multirotor(
    client: AirSimClient,
    name: String,
    originNed: Vector3 = Vector3.Zero,
    connectionKey: Int = 0
) extends VehicleClient(client, name, originNed, connectionKey),
      AttitudeMoves:
  import Multirotor.*

  // ---- state

  def status(): Future[Either[RpcError, Stamped[MultirotorStatus]]] =
    stateOf("getMultirotorState"): (state: MultirotorReading) =>
      val motion = inWorld(state.kinematics_estimated)
      (MultirotorStatus(motion, flying = state.landed_state == 1, state.skein_missing), state.timestamp)

  /** Lets the vehicle hover at a position above the ground, level and at rest, with its controllers settled;
    * it must be under API control. Only the built-in simulator supports this.
    */
  def hoverAt(pose: VehiclePose): Future[Either[RpcError, Unit]] = tell("skeinHoverAt", own(pose))

  /** Rotors in AirSim's order: front right, rear left, front left, rear right. */
  def rotors(): Future[Either[RpcError, Stamped[Seq[RotorReading]]]] =
    stamped("getRotorStates"): (states: RotorStates) =>
      val rotors = states.rotors.map(rotor => RotorReading(rotor.thrust, rotor.torque_scaler, rotor.speed))
      (rotors, states.timestamp)

  // ---- moves

  def arm(): Future[Either[RpcError, Boolean]] = ask("armDisarm", Bool(true))

  def disarm(): Future[Either[RpcError, Boolean]] = ask("armDisarm", Bool(false))

  /** Climbs by 2 m. AirSim stops half a metre short and answers false. */
  def takeoff(timeout: Span = Span.ofSeconds(20)): Future[Either[RpcError, Boolean]] =
    move("takeoff", timeout, seconds(timeout))

  /** Descends at 0.2 m/s until it stands on the ground. */
  def land(timeout: Span = Span.ofSeconds(60)): Future[Either[RpcError, Boolean]] =
    move("land", timeout, seconds(timeout))

  def goHome(timeout: Span = Span.ofSeconds(600)): Future[Either[RpcError, Boolean]] =
    move("goHome", timeout, seconds(timeout))

  /** Ends the current move; 60 ms later the vehicle holds the position that it has then. AirSim answers
    * false.
    */
  def hover(): Future[Either[RpcError, Boolean]] = move("hover", Span.Zero)

  /** Flies with a velocity.
    *
    * @param velocityNed m/s
    * @param withdrawn when it completes, the answer is no longer awaited
    */
  def moveByVelocity(
      velocityNed: Vector3,
      duration: Span,
      yaw: Yaw = Yaw.Still,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocity", velocityNed.x, velocityNed.y, velocityNed.z, duration, yaw, withdrawn)

  /** Flies with a horizontal velocity at an altitude: the paper's command.
    *
    * @param velocityNed m/s; its third component is ignored
    * @param down altitude goal, world NED
    * @param withdrawn when it completes, the answer is no longer awaited
    */
  def moveByVelocityZ(
      velocityNed: Vector3,
      down: Metres,
      duration: Span,
      yaw: Yaw = Yaw.Still,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityZ", velocityNed.x, velocityNed.y, ownDown(down), duration, yaw, withdrawn)

  /** Like [[moveByVelocity]], in the frame given by the vehicle's heading at the start of the move. */
  def moveByVelocityBodyFrame(
      velocity: Vector3,
      duration: Span,
      yaw: Yaw = Yaw.Still
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityBodyFrame", velocity.x, velocity.y, velocity.z, duration, yaw)

  /** Like [[moveByVelocityZ]], in the frame given by the vehicle's heading at the start of the move. */
  def moveByVelocityZBodyFrame(
      velocity: Vector3,
      down: Metres,
      duration: Span,
      yaw: Yaw = Yaw.Still
  ): Future[Either[RpcError, Boolean]] =
    byVelocity("moveByVelocityZBodyFrame", velocity.x, velocity.y, ownDown(down), duration, yaw)

  def moveToPosition(
      positionNed: Vector3,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val own = positionNed - originNed
    move(
      "moveToPosition",
      timeout,
      Seq(real(own.x), real(own.y), real(own.z)) ++ along(speed, timeout, yaw, lookahead)*
    )

  def moveOnPath(
      pathNed: Seq[Vector3],
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val path = writeMsg(pathNed.map(point => Vector3r(point - originNed)))
    move("moveOnPath", timeout, path +: along(speed, timeout, yaw, lookahead)*)

  def moveToZ(
      down: Metres,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    move(
      "moveToZ",
      timeout,
      Seq(real(ownDown(down)), real(speed.value), seconds(timeout), writeMsg(yaw.mode)) ++ lookahead.params*
    )

  def moveToGps(
      location: GeoLocation,
      speed: MetresPerSecond,
      timeout: Span = Span.ofSeconds(600),
      yaw: Yaw = Yaw.Still,
      lookahead: Lookahead = Lookahead.Automatic
  ): Future[Either[RpcError, Boolean]] =
    val place =
      Seq(Float64(location.latitudeDeg), Float64(location.longitudeDeg), real(location.altitude.value))
    move("moveToGPS", timeout, place ++ along(speed, timeout, yaw, lookahead)*)

  /** Turns until the heading is within `margin`. */
  def rotateToYaw(
      heading: Radians,
      timeout: Span = Span.ofSeconds(60),
      margin: Radians = Radians(math.toRadians(5))
  ): Future[Either[RpcError, Boolean]] =
    move("rotateToYaw", timeout, degrees(heading.value), seconds(timeout), degrees(margin.value))

  /** @param radiansPerSecond clockwise, seen from above */
  def rotateByYawRate(radiansPerSecond: Double, duration: Span): Future[Either[RpcError, Boolean]] =
    move("rotateByYawRate", duration, degrees(radiansPerSecond), seconds(duration))

  /** Gives the vehicle's buffer a plan of velocities. The buffer answers as soon as it has the plan; the
    * call's timeout includes the plan's duration. Plans may overtake one another, since each takes the
    * connection with the fewest calls in flight. The built-in simulator supports this, and `link --buffer` in
    * front of another one.
    *
    * @param number sequence number, greater than those of all earlier plans
    * @return None if an action of the plan is not a velocity
    */
  def followPlan(number: Long, plan: CommandPlan): Option[Future[Either[RpcError, Boolean]]] =
    val last  = plan.actions.lastOption.fold(Instant.Epoch)(_.at + CommandPlan.Hold)
    val calls = plan.actions.flatMap: (at, action) =>
      planned(action, last.since(at)).map((method, params) =>
        Arr(Int64(at.toNanos), Str(method), Arr(params*))
      )
    Option.when(calls.size == plan.actions.size):
      val acts = plan.actions.headOption.fold(Span.Zero)(first => last.since(first.at))
      call("skeinFollowPlan", Seq(Int64(number), Arr(calls*)), once.copy(timeout = client.timeout + acts))

  /** Calls a function that moves the vehicle, by its name.
    *
    * @param params the function's parameters, without the vehicle
    * @param withdrawn when it completes, the answer is no longer awaited
    */
  def perform(
      method: String,
      params: Seq[Msg],
      lasts: Span,
      withdrawn: Future[?]
  ): Future[Either[RpcError, Boolean]] =
    call(method, params, moving(lasts).copy(withdrawn = Some(withdrawn)))

  /** Ends all plans with a smaller sequence number, even those that arrive later, and lets the vehicle hover.
    */
  def endPlans(number: Long): Future[Either[RpcError, Boolean]] =
    val hover = Arr(Int64(0), Str("hover"), Arr(Seq.empty[Msg]*))
    call("skeinFollowPlan", Seq(Int64(number), Arr(hover)), once)

  private def planned(action: Action, lasts: Span): Option[(String, Seq[Msg])] = action match
    case Action.VelocityAt(north, east, down, yaw) =>
      Some(("moveByVelocityZ", velocityParams(north, east, ownDown(down), lasts, yaw)))
    case Action.Velocity(velocityNed, yaw) =>
      Some(("moveByVelocity", velocityParams(velocityNed.x, velocityNed.y, velocityNed.z, lasts, yaw)))
    case along: Action.Along => planned(along.byVelocity, lasts)
    case Action.Hover        => Some(("hover", Seq.empty))
    case _                   => None

  // ---- helpers

  private def byVelocity(
      method: String,
      x: Double,
      y: Double,
      third: Double,
      duration: Span,
      yaw: Yaw,
      withdrawn: Option[Future[?]] = None
  ): Future[Either[RpcError, Boolean]] =
    val params = velocityParams(x, y, third, duration, yaw)
    call(method, params, moving(duration).copy(withdrawn = withdrawn))

  private def velocityParams(x: Double, y: Double, third: Double, duration: Span, yaw: Yaw): Seq[Msg] =
    Seq(real(x), real(y), real(third), seconds(duration), Int32(yaw.drivetrain), writeMsg(yaw.mode))

  protected def attitude(
      method: String,
      duration: Span,
      numbers: Double*
  ): Future[Either[RpcError, Boolean]] = move(method, duration, numbers.map(real) :+ seconds(duration)*)

  private def along(speed: MetresPerSecond, timeout: Span, yaw: Yaw, lookahead: Lookahead): Seq[Msg] =
    Seq(real(speed.value), seconds(timeout), Int32(yaw.drivetrain), writeMsg(yaw.mode)) ++ lookahead.params

  private def move(method: String, lasts: Span, params: Msg*): Future[Either[RpcError, Boolean]] =
    call(method, params, moving(lasts))

  private def moving(lasts: Span) = inOrder.copy(timeout = client.timeout + lasts)

  protected def ownDown(down: Metres): Double = down.value - originNed.z

  private def seconds(span: Span): Msg      = real(span.toSeconds)
  private def degrees(radians: Double): Msg = real(math.toDegrees(radians))

  def over(client: AirSimClient, originNed: Vector3, connectionKey: Int): Multirotor =
    Multirotor(client, name, originNed, connectionKey)

object Multirotor:

  /** The vehicle of this name; its origin is read from the simulator's settings. */
  def named(client: AirSimClient, name: String): Future[Either[AirSimError, Multirotor]] =
    VehicleClient.named(client, name, Multirotor(client, name, _, _))

  extension (yaw: Yaw)
    private def mode: YawMode = yaw match
      case Yaw.Still            => YawMode.Still
      case Yaw.Towards(heading) => YawMode(is_rate = false, math.toDegrees(heading.value).toFloat)
      case Yaw.Turning(rate)    => YawMode(is_rate = true, math.toDegrees(rate).toFloat)
      case Yaw.Forward          => YawMode(is_rate = false, 0)

    /** AirSim's drivetrain number: 1 forward only, 0 any direction. */
    private def drivetrain: Int = if yaw == Yaw.Forward then 1 else 0
