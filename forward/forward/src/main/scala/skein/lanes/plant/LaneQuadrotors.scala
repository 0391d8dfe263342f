package skein.lanes.plant

import skein.forward.SteppedVehicles
import skein.lanes.policy.Directions
import skein.simd.LaneFunction
import skein.units.{Vector3, eachBelow}
import skein.vehicle.{Quadrotor, QuadrotorState}

/** Simulates quadrotors with their flight controllers, [[LaneQuadrotors.VEHICLES]] at a time, in floats,
  * under `moveByVelocityZ`. The code is compiled from the scalar [[Quadrotor]], which is also the reference
  * ([[QuadrotorLanes]]). Mutable; one per thread.
  */
private[skein] final class LaneQuadrotors private[lanes] (lanes: QuadrotorLanes) extends SteppedVehicles:
  import LaneQuadrotors.VEHICLES
  private val one, other = Array.ofDim[Float](lanes.rows.size * VEHICLES)

  private val goal    = Array.ofDim[Float](3 * VEHICLES)
  private val steps   = Array(lanes.step(one, other, goal), lanes.step(other, one, goal))
  private var isOther = false

  // The last position to hover at, and the state there: nearly always all vehicles hover there.
  private var heldNed                 = Vector3.Zero
  private var holding: Vector[Double] = lanes.numbersOf(lanes.quadrotor.hovering(heldNed))

  def state: Array[Float] = if isOther then other else one

  private def rowOf(name: String) = lanes.row(name) * VEHICLES

  /** Indices in [[state]] of the first vehicle's components: world NED, m, m/s and m/s². */
  val X: Int  = rowOf("x")
  val Y: Int  = rowOf("y")
  val Z: Int  = rowOf("z")
  val VX: Int = rowOf("vx")
  val VY: Int = rowOf("vy")
  val VZ: Int = rowOf("vz")
  val AX: Int = rowOf("ax")
  val AY: Int = rowOf("ay")
  val AZ: Int = rowOf("az")

  private val (qw, qx, qy, qz) = (rowOf("qw"), rowOf("qx"), rowOf("qy"), rowOf("qz"))
  private val (wx, wy, wz)     = (rowOf("wx"), rowOf("wy"), rowOf("wz"))

  def use(vehicles: Int): Unit = steps.foreach(_.use(vehicles))

  /** Lets a vehicle hover at rest under the command to hold this position. */
  def hover(place: Int, goalNed: Vector3): Unit =
    if goalNed != heldNed then
      heldNed = goalNed
      holding = lanes.numbersOf(lanes.quadrotor.hovering(goalNed))
    for row <- holding.indices do state(row * VEHICLES + place) = holding(row).toFloat
    command(place, 0, 0, goalNed.z.toFloat)

  def hover(place: Int, downM: Double): Unit = hover(place, holdingAt(downM))

  /** The position to command so that a vehicle settles at altitude `downM`, above its start. */
  def holdingAt(downM: Double): Vector3 = lanes.holdingAt(downM)

  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit =
    goal(place) = northMps
    goal(VEHICLES + place) = eastMps
    goal(2 * VEHICLES + place) = downM

  def command(commanded: Directions, from: Int, speedMps: Float, downM: Float): Unit =
    eachBelow(VEHICLES): place =>
      command(place, commanded.cos(from + place) * speedMps, commanded.sin(from + place) * speedMps, downM)

  def step(): Unit = fly(1)

  def fly(count: Int): Unit =
    eachBelow(count): _ =>
      steps(if isOther then 1 else 0)()
      isOther = !isOther

  def positionNed(place: Int): Vector3 = Vector3(state(X + place), state(Y + place), state(Z + place))
  def velocityNed(place: Int): Vector3 = Vector3(state(VX + place), state(VY + place), state(VZ + place))

  def read(place: Int, into: QuadrotorState): Unit =
    into.x = state(X + place); into.y = state(Y + place); into.z = state(Z + place)
    into.vx = state(VX + place); into.vy = state(VY + place); into.vz = state(VZ + place)
    into.ax = state(AX + place); into.ay = state(AY + place); into.az = state(AZ + place)
    into.qw = state(qw + place); into.qx = state(qx + place)
    into.qy = state(qy + place); into.qz = state(qz + place)
    into.wx = state(wx + place); into.wy = state(wy + place); into.wz = state(wz + place)

private[skein] object LaneQuadrotors:
  /** Number of vehicles that are simulated together. */
  val VEHICLES: Int = LaneFunction.COUNT

  /** Compiles quadrotors. Left says why SIMD does not support them. */
  def of(quadrotor: Quadrotor): Either[String, LaneQuadrotors] =
    QuadrotorLanes.of(quadrotor).map(new LaneQuadrotors(_))
