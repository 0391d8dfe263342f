package skein.lanes.plant

import skein.forward.SteppedVehicles
import skein.lanes.policy.Directions
import skein.simd.LaneFunction
import skein.units.{Quaternion, Vector3, eachBelow}
import skein.vehicle.Quadrotor

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

  private val orientation: Vector[Int] = Vector("qw", "qx", "qy", "qz").map(rowOf)
  private val angular: Vector[Int]     = Vector("wx", "wy", "wz").map(rowOf)

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
    var left = count
    while left > 0 do
      steps(if isOther then 1 else 0)()
      isOther = !isOther
      left -= 1

  def positionNed(place: Int): Vector3 = Vector3(x(place), y(place), z(place))
  def velocityNed(place: Int): Vector3 = Vector3(vx(place), vy(place), vz(place))

  def x(place: Int): Double  = state(X + place)
  def y(place: Int): Double  = state(Y + place)
  def z(place: Int): Double  = state(Z + place)
  def vx(place: Int): Double = state(VX + place)
  def vy(place: Int): Double = state(VY + place)
  def vz(place: Int): Double = state(VZ + place)
  def ax(place: Int): Double = state(AX + place)
  def ay(place: Int): Double = state(AY + place)
  def az(place: Int): Double = state(AZ + place)

  def orientation(place: Int): Quaternion =
    val Vector(w, x, y, z) = orientation.map(row => state(row + place).toDouble): @unchecked
    Quaternion(w, x, y, z)

  def angularVelocityFrd(place: Int): Vector3 =
    val Vector(front, right, down) = angular.map(row => state(row + place).toDouble): @unchecked
    Vector3(front, right, down)

private[skein] object LaneQuadrotors:
  /** Number of vehicles that are simulated together. */
  val VEHICLES: Int = LaneFunction.COUNT

  /** Compiles quadrotors. Left says why SIMD does not support them. */
  def of(quadrotor: Quadrotor): Either[String, LaneQuadrotors] =
    QuadrotorLanes.of(quadrotor).map(new LaneQuadrotors(_))
