package skein.simulator

import skein.airsim.wire.YawMode
import skein.units.*
import skein.units.Decimals.fixed
import skein.vehicle.{PathFollowing, Setpoint}

/** Options of a flight along a path.
  *
  * @param lookaheadM distance ahead on the path at which to aim; negative: in proportion to the speed
  * @param adaptive fraction of the distance from the path that is added to the lookahead
  */
final private[simulator] case class Travel(
    drivetrain: Int,
    yaw: YawMode,
    lookaheadM: Float,
    adaptive: Float
)

private[simulator] object Travel:
  /** The settings of AirSim's own moves. */
  val Plain: Travel = Travel(0, YawMode.Still, -1, 1)

/** Flies along a path by aiming at a point ahead on it, with a velocity command
  * (`MultirotorApiBase::moveOnPath`).
  *
  * @param points the path's points; the first is the vehicle's position at the start
  */
final private[simulator] class PathMove private (
    points: Vector[Vector3],
    speedMps: Double,
    timeout: Span,
    travel: Travel,
    lookaheadM: Double
) extends Move:
  import PathMove.*

  private val last    = points.size - 1
  private val lengths = points.zip(points.tail).map((from, to) => (to - from).norm) :+ 0.0
  private val before  = lengths.scanLeft(0.0)(_ + _)

  /** For each segment, the first segment of nonzero length from there on. */
  private val solid = lengths.indices.scanRight(last)((segment, next) =>
    if segment >= last then last else if lengths(segment) > 0 then segment else next
  )

  private var reached  = Place(0, 0, points.head)
  private var aim      = ahead(reached, lookaheadM)
  private var progress = 0.0
  private var complete = false

  def turn(vehicle: SimulatedMultirotor, elapsed: Span): MoveProgress =
    val position = vehicle.state.positionNed
    if elapsed > Span.Zero then follow(position)
    if elapsed >= timeout || (aim.segment >= last && progress <= 0) then MoveProgress.Ended(complete, None)
    else MoveProgress.Going(towardsAim(position))

  /** Updates the progress towards the current aim, and moves the aim. */
  private def follow(position: Vector3): Unit =
    val wanted = aim.point - reached.point
    val length = wanted.norm
    val strays =
      if length == 0 then
        complete = true
        progress = 0
        0.0
      else
        val actual    = position - reached.point
        val direction = wanted * (1 / length)
        progress = dot(actual, direction)
        (actual - direction * progress).norm * travel.adaptive
    // Progress on the path is never taken back, even if the vehicle is pushed back.
    if progress >= 0 then reached = ahead(reached, progress)
    aim = ahead(reached, lookaheadM + strays)

  private def towardsAim(position: Vector3): Setpoint =
    val way       = aim.point - position
    val remaining = before(last) - before(reached.segment) - reached.offsetM
    val speed     = if speedMps > 3 && remaining <= 0 then 1.0 else speedMps
    val velocity  = PathFollowing.velocityNed(way, speed)
    Move.withYaw(
      Setpoint.velocity(velocity.x, velocity.y, velocity.z),
      Move.facing(travel.drivetrain, travel.yaw, way)
    )

  /** The position `distanceM` ahead on the path. Nearby segments are walked and farther ones searched, so
    * that thousands of coinciding points cost no more.
    */
  private def ahead(from: Place, distanceM: Double): Place =
    var segment  = solid(from.segment)
    var offset   = from.offsetM + distanceM
    var walked   = 0
    def isBeyond = segment < last && lengths(segment) < offset
    while isBeyond && walked < MostWalked do
      offset -= lengths(segment)
      segment = solid(segment + 1)
      walked += 1
    if isBeyond then
      val goal        = before(segment) + offset
      var (low, high) = (segment, last)
      while low < high do
        val middle = (low + high) / 2
        if before(middle + 1) >= goal then high = middle else low = middle + 1
      segment = low
      offset = goal - before(low)
    if segment == last then Place(last, 0, points(last))
    else
      val along = (points(segment + 1) - points(segment)) * (offset / lengths(segment))
      Place(segment, offset, points(segment) + along)

private[simulator] object PathMove:
  private val MostWalked = 64

  /** A position on the path: the segment that starts at path point `segment`, and the distance along it. */
  private case class Place(segment: Int, offsetM: Double, point: Vector3)

  def order(path: Seq[Vector3], speedMps: Float, timeoutS: Float, travel: Travel): Move.Order = vehicle =>
    val perTurn   = speedMps * PathFollowing.Period.toSeconds
    val lookahead = travel.lookaheadM
    if path.isEmpty then Right((_, _) => MoveProgress.Ended(true, None))
    else if travel.drivetrain == Move.ForwardOnly && travel.yaw.is_rate then
      Left("Yaw cannot be specified as rate if drivetrain is ForwardOnly")
    else if lookahead == 0 then Left("lookahead distance cannot be 0")
    else if lookahead > 0 && perTurn > lookahead then
      Left(
        s"lookahead value ${lookahead.fixed(6)} is too small for velocity " +
          s"${speedMps.fixed(6)}. It must be at least ${perTurn.fixed(6)}"
      )
    else if lookahead > 0 && PathFollowing.DistanceAccuracyM > lookahead then
      Left(
        s"lookahead value ${lookahead.fixed(6)} is smaller than drone's " +
          s"distance accuracy ${PathFollowing.DistanceAccuracyM.fixed(6)}."
      )
    else
      val distance =
        if lookahead > 0 then lookahead.toDouble
        else PathFollowing.lookaheadM(speedMps, travel.adaptive > 0)
      Right(PathMove(
        vehicle.state.positionNed +: path.toVector,
        speedMps,
        Move.span(timeoutS),
        travel,
        distance
      ))

  /** AirSim's takeoff: a path 2 m up, which it ends half a metre short. */
  def takeoff(timeoutS: Float): Move.Order = vehicle =>
    val speed = vehicle.state.velocityNed.norm
    if speed > Move.ApproximatelyZeroMps then
      Left(s"Cannot perform takeoff because vehicle is already moving with velocity ${speed.fixed(6)} m/s")
    else
      order(
        Seq(vehicle.state.positionNed + Vector3(0, 0, -2)),
        0.5f,
        timeoutS,
        Travel.Plain
      )(vehicle)

  private def dot(a: Vector3, b: Vector3): Double = a.x * b.x + a.y * b.y + a.z * b.z
