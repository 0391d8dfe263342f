package skein.mujoco

import java.nio.file.Files
import scala.util.Random
import skein.testing.Waiting
import skein.units.{Quaternion, Vector3}
import skein.vehicle.*

/** The quadrotor's rigid body compared with MuJoCo's independent one: AirSim's quadrotor as MJCF, integrated
  * by Runge-Kutta's method of the fourth order. MuJoCo receives the rotors' thrusts, and the drag, which it
  * does not model; both take equal steps.
  *
  * AirSim's velocity Verlet uses an acceleration computed for the middle of a step as that of the step's end.
  * So accelerations act half a step late, and its error is of the first order: it halves with half the step.
  * In the limit of small steps both agree with MuJoCo.
  */
class MujocoOracleLiveSuite extends MujocoHere, Waiting:
  import MujocoOracleLiveSuite.*

  private def beside(name: String, fall: Fall, stepS: Double = 0.003, lastsS: Int = 10): Unit = test(name):
    assumeMujoco()
    val coarse  = flown(fall, stepS, lastsS)
    val fine    = flown(fall, stepS / 2, lastsS)
    val without = coarse.zip(fine).map((c, f) => f * 2 - c)
    val told    = s"$name, at ${stepS * 1000} ms: ${shown(coarse)}; at half of it: ${shown(fine)}; " +
      s"without the error of the first order: ${shown(without)}"
    println(told)
    assertEqualsDouble(positionM(coarse) / positionM(fine), 2, 0.1, told)
    if attitudeDeg(coarse) > 1e-3 then
      assertEqualsDouble(attitudeDeg(coarse) / attitudeDeg(fine), 2, 0.1, told)
    assert(positionM(without) < 1e-3, told)
    assert(attitudeDeg(without) < 0.01, told)

  beside("free flight of 10 s, thrown up, with drag", Fall(Vector3(6, -4, -12), Vector3.Zero, _ => None))

  beside("a slow spin of 10 s about all axes", Fall(Vector3.Zero, Vector3(0.5, -0.4, 0.6), _ => None))

  beside("a fast spin of 3 s about all axes", Fall(Vector3.Zero, Vector3(3, -2.5, 3.5), _ => None), 0.0001, 3)

  beside(
    "steps of the rotors for 10 s, from hovering",
    Fall(
      Vector3.Zero,
      Vector3.Zero,
      second =>
        val random = Random(second)
        Some(Vector.fill(4)(HoverControl + (random.nextDouble() - 0.5) * 0.004))
    )
  )

private object MujocoOracleLiveSuite:
  /** The initial motion, and the rotors' controls in each second; None: rotors at rest. */
  final case class Fall(velocityNed: Vector3, ratesFrd: Vector3, rotors: Int => Option[Vector[Double]])

  /** Deviation from MuJoCo at one instant: position, m, and the rotation vector between both, rad. */
  final case class Apart(position: Vector3, rotation: Vector3):
    def *(factor: Double): Apart = Apart(position * factor, rotation * factor)
    def -(other: Apart): Apart   = Apart(position - other.position, rotation - other.rotation)

  def positionM(apart: Seq[Apart]): Double = apart.map(_.position.norm).max

  def attitudeDeg(apart: Seq[Apart]): Double = math.toDegrees(apart.map(_.rotation.norm).max)

  def shown(apart: Seq[Apart]): String =
    s"${(positionM(apart) * 1e6).round} µm, ${(attitudeDeg(apart) * 1e6).round / 1e6}°"

  /** The state component of external forces, `mjSTATE_XFRC_APPLIED`. */
  private val ForcesFromOutside = 1 << 8

  /** One simulation of a model, whose state is accessed by its parts. */
  final class World(xml: String):
    private val batch =
      val file = Files.createTempFile("model", ".xml")
      try
        Files.writeString(file, xml)
        MujocoModel.load(file).flatMap(MujocoBatch.of(_, 1)).fold(sys.error, identity)
      finally Files.delete(file)

    def advance(): Unit =
      batch.mark(0)
      batch.step()

    def read(part: Int): Vector[Double] =
      val at = batch.part(part)
      Vector.tabulate(at.size)(index => batch(0, at.at + index))

    def write(part: Int, values: Seq[Double]): Unit =
      val at = batch.part(part)
      require(values.size == at.size, s"expected ${at.size} numbers, got ${values.size}")
      values.zipWithIndex.foreach((value, index) => batch(0, at.at + index) = value)

  private val airframe     = Airframe()
  private val altitudeM    = 500.0
  private val environment  = Environment.Calm
  private val HoverControl = Quadrotor.AirSim.hoverControl(-altitudeM)

  /** Deviations every 0.3 s of a fall. */
  def flown(fall: Fall, stepS: Double, lastsS: Int): Vector[Apart] =
    val quadrotor = Quadrotor(stepS = stepS)
    val state     = QuadrotorState()
    val world     = World(model(stepS))
    val spinning  = fall.ratesFrd
    state.z = -altitudeM
    state.vx = fall.velocityNed.x; state.vy = fall.velocityNed.y; state.vz = fall.velocityNed.z
    state.wx = spinning.x; state.wy = spinning.y; state.wz = spinning.z
    if fall.rotors(0).isDefined then
      val control = HoverControl
      state.control0 = control; state.control1 = control; state.control2 = control; state.control3 = control
      state.lagged0 = control; state.lagged1 = control; state.lagged2 = control; state.lagged3 = control
      state.thrust0 = control; state.thrust1 = control; state.thrust2 = control; state.thrust3 = control
    else
      // The acceleration that Verlet's method assumes for the step before the first.
      val drag = dragNed(fall.velocityNed, Quaternion.Identity, altitudeM) * (1 / airframe.massKg)
      state.ax = drag.x; state.ay = drag.y; state.az = drag.z + Airframe.Gravity
      state.wxDot =
        -spinning.y * spinning.z * (airframe.inertiaDown - airframe.inertiaRight) / airframe.inertiaFront
      state.wyDot =
        -spinning.z * spinning.x * (airframe.inertiaFront - airframe.inertiaDown) / airframe.inertiaRight
      state.wzDot =
        -spinning.x * spinning.y * (airframe.inertiaRight - airframe.inertiaFront) / airframe.inertiaDown
    world.write(MujocoBatch.Positions, turned(Vector3(0, 0, -altitudeM)) ++ Seq(1.0, 0.0, 0.0, 0.0))
    world.write(MujocoBatch.Velocities, turned(fall.velocityNed) ++ turned(spinning))

    var before       = thrusts(state)
    var velocity     = fall.velocityNed
    var acceleration = Vector3(state.ax, state.ay, state.az)
    val apart        = Vector.newBuilder[Apart]
    val every        = (0.3 / stepS).round.toInt
    for step <- 0 until every * (lastsS / 0.3).toInt do
      val controls      = fall.rotors((step * stepS).toInt).getOrElse(Vector.fill(4)(0.0))
      val (place, turn) = poseOf(world)
      val density       = Atmosphere.densityRatio(environment.originAltitudeM - place.z)
      val now           = thrusts(state)
      world.write(MujocoBatch.Controls, now.zip(before).map((a, b) => (a + b) / 2 * density))
      before = now
      // In the middle of the step, as Verlet's method has it.
      val drag = dragNed(velocity + acceleration * (stepS / 2), turn, -place.z)
      world.write(ForcesFromOutside, Seq.fill(6)(0.0) ++ turned(drag) ++ Seq.fill(3)(0.0))
      world.advance()
      val next = untold(world.read(MujocoBatch.Velocities).take(3))
      acceleration = (next - velocity) * (1 / stepS)
      velocity = next
      quadrotor.step(state, Setpoint.rotors(controls(0), controls(1), controls(2), controls(3)), environment)
      if (step + 1) % every == 0 then
        val (theirs, their) = poseOf(world)
        apart += Apart(state.positionNed - theirs, between(their, state.orientation))
    apart.result()

  private def thrusts(state: QuadrotorState) =
    Vector(state.thrust0, state.thrust1, state.thrust2, state.thrust3)

  /** Converts between north, east, down and MuJoCo's x, y, z, which here are north, west, up; also for body
    * axes.
    */
  private def turned(v: Vector3): Seq[Double] = Seq(v.x, -v.y, -v.z)

  private def untold(v: Seq[Double]): Vector3 = Vector3(v(0), -v(1), -v(2))

  private def poseOf(world: World): (Vector3, Quaternion) =
    val q = world.read(MujocoBatch.Positions)
    (untold(q), Quaternion(q(3), q(4), -q(5), -q(6)))

  /** AirSim's drag on three pairs of faces, N. */
  private def dragNed(velocityNed: Vector3, turn: Quaternion, altitudeM: Double): Vector3 =
    val density =
      Atmosphere.SeaLevelDensity * Atmosphere.densityRatio(environment.originAltitudeM + altitudeM)
    val body                                = turn.toBody(velocityNed)
    def face(factor: Double, speed: Double) =
      if speed.abs > airframe.dragMinSpeed then -factor * density * speed * speed.abs else 0.0
    turn.toWorld(Vector3(
      face(airframe.dragFront, body.x),
      face(airframe.dragRight, body.y),
      face(airframe.dragDown, body.z)
    ))

  /** The rotation vector of a small rotation from a to b. */
  private def between(a: Quaternion, b: Quaternion): Vector3 =
    val w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z
    Vector3(
      a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y,
      a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x,
      a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w
    ) * (2 * math.signum(w))

  /** AirSim's quadrotor, with a motor for each rotor: a control of 1 is full thrust at sea level. */
  private def model(stepS: Double): String =
    val o = airframe.rotorOffsetM
    // Front right, rear left, front left, rear right; y points to the left.
    val rotors = Seq((o, -o, -1), (-o, o, -1), (o, o, 1), (-o, -o, 1)).zipWithIndex
    val sites  = rotors.map { case ((x, y, _), i) =>
      s"""<site name="r$i" pos="$x $y ${-airframe.rotorDownM}"/>"""
    }
    val motors = rotors.map { case ((_, _, sign), i) =>
      s"""<motor site="r$i" gear="0 0 ${airframe.maxThrustN} 0 0 ${sign * airframe.maxTorqueNm}"/>"""
    }
    s"""<mujoco model="airsim-quadrotor">
       |  <option timestep="$stepS" gravity="0 0 ${-Airframe.Gravity}" integrator="RK4"/>
       |  <worldbody>
       |    <body name="quadrotor">
       |      <freejoint/>
       |      <inertial pos="0 0 0" mass="${airframe.massKg}"
       |        diaginertia="${airframe.inertiaFront} ${airframe.inertiaRight} ${airframe.inertiaDown}"/>
       |      ${sites.mkString("\n      ")}
       |    </body>
       |  </worldbody>
       |  <actuator>
       |    ${motors.mkString("\n    ")}
       |  </actuator>
       |</mujoco>
       |""".stripMargin
