package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.nio.file.{Files, Path}
import skein.vehicle.{Airframe, Environment, Quadrotor, QuadrotorState}

/** A multirotor in MuJoCo's XML. Its body is the one of the first joint, a free one; its z is up. What its actuators do is
  * measured: each is held at a control until it has settled, and the accelerations are read.
  *
  * @param text
  *   names it in messages
  */
final class MujocoModel private (val text: String, private[mujoco] val compiled: MemorySegment):
  import MujocoModel.*
  import MujocoBatch.*

  private val one = MujocoBatch(compiled, 1)

  private val position                = one.part(Positions)
  private val velocity                = one.part(Velocities)
  private[mujoco] val positionAt      = position.at
  private[mujoco] val velocityAt      = velocity.at
  private[mujoco] val controlAt       = one.part(Controls).at
  private[mujoco] val timeAt          = one.part(Time).at
  private[mujoco] val actuators       = one.part(Controls).size
  private[mujoco] val row             = one.row
  private val initial: Vector[Double] =
    one.reset()
    one.rowOf(0).toVector

  if position.size < 7 || one.ints("jnt_type").head != FreeJoint then
    refuse("expected the vehicle's free joint to be the first joint")
  if actuators < 4 then refuse(s"expected at least 4 actuators, came $actuators")

  /** Of a step, s. */
  val stepS: Double = one.doubles("opt.timestep").head

  /** The body's height in the model, m: where it stands on the ground. */
  private[mujoco] val standsAtM: Double = initial(positionAt + 2)

  private val limited        = one.flags("actuator_ctrllimited")
  private val ranges         = one.doubles("actuator_ctrlrange")
  private[mujoco] val lowest =
    Array.tabulate(actuators)(i => if limited(i) then ranges(2 * i) else Double.NegativeInfinity)
  private[mujoco] val highest =
    Array.tabulate(actuators)(i => if limited(i) then ranges(2 * i + 1) else Double.PositiveInfinity)

  /** The control closest to none. */
  private[mujoco] val resting = Array.tabulate(actuators)(i => 0.0.max(lowest(i)).min(highest(i)))

  /** With all controls at rest. */
  private val falling  = measured(resting)
  private val measures = Array.tabulate(actuators): actuator =>
    val full      = if highest(actuator).isInfinite then resting(actuator) + 1 else highest(actuator)
    val (to, way) = (resting.clone, full - resting(actuator))
    if way <= 0 then refuse(s"actuator $actuator: expected a control range above ${resting(actuator)}")
    def at(share: Double) =
      to(actuator) = resting(actuator) + share * way
      measured(to).zip(falling).map((a, b) => (a - b) / (share * way))
    val (half, whole) = (at(0.5), at(1))
    val greatest      = whole.map(math.abs).max
    if half.zip(whole).exists((a, b) => math.abs(a - b) > NotInProportion * greatest) then
      refuse(s"actuator $actuator: expected a force in proportion to its control")
    whole

  /** What of its controls lifts it, m/s² for one more. */
  private val lifting: Array[Double]     = measures.map(_(0))
  private[mujoco] val weightMps2: Double = -falling(0)
  if weightMps2 <= 0 then refuse("expected gravity along −z")

  private[mujoco] val allocation: Allocation =
    Allocation.of(Array.tabulate(4, actuators)((axis, actuator) => measures(actuator)(axis))) match
      case Right(found) => found
      case Left(reason) => refuse(reason)

  /** The actuators of the rotors front right, rear left, front left, rear right, where it has just these four. */
  private[mujoco] val rotors: Option[Array[Int]] =
    val corners = measures.toVector.map(effect => (math.signum(effect(1)), math.signum(effect(2))))
    val found   = Corners.map(corners.indexOf)
    Option.when(actuators == 4 && found.forall(_ >= 0) && lifting.forall(_ > 0))(found.toArray)

  /** Whether its actuators are four rotors, one at each corner, which can be told their controls one by one. */
  def hasRotors: Boolean = rotors.isDefined

  private val hovering =
    val wanted = Array.tabulate(actuators)(i => resting(i) + allocation.control(i, weightMps2, 0, 0, 0))
    for i <- 0 until actuators if wanted(i) < lowest(i) || wanted(i) > highest(i) do
      refuse(
        s"actuator $i: expected a control range with ${wanted(i)}, by which it hovers, came ${lowest(i)} to ${highest(i)}"
      )
    settled(wanted)

  private val standing = settled(resting)

  /** Rows of one that has long hovered, and of one that stands. */
  private[mujoco] def hoveringRow: Array[Double] = hovering
  private[mujoco] def standingRow: Array[Double] = standing

  /** Whether what its actuators are told lifts it off the ground. */
  private[mujoco] def lifts(controls: Array[Double]): Boolean =
    var lift = 0.0
    for i <- controls.indices do lift += lifting(i) * (controls(i) - resting(i))
    lift >= weightMps2

  /** Accelerations at rest, level, well above everything: upwards, m/s², about front, right and down, rad/s². */
  private def measured(controls: Array[Double]): Array[Double] =
    one.setRow(0, settled(controls))
    for i <- 0 until velocity.size do one(0, velocityAt + i) = 0
    one(0, positionAt + 2) = HighM
    one.mark(0)
    one.step()
    def change(index: Int) = one(0, velocityAt + index) / stepS
    Array(change(2), change(3), -change(4), -change(5))

  /** The row of one that was held at its initial place until its actuators had settled. */
  private def settled(controls: Array[Double]): Array[Double] =
    one.reset()
    val held = initial.toArray
    held(positionAt + 2) = HighM
    for i <- controls.indices do held(controlAt + i) = controls(i)
    one.setRow(0, held)
    for _ <- 0 until (SettlingS / stepS).ceil.toInt do
      one.mark(0)
      one.step()
      for part <- Seq(position, velocity); i <- part.at until part.at + part.size do one(0, i) = held(i)
    one(0, positionAt + 2) = standsAtM
    one(0, timeAt) = 0
    one.rowOf(0)

  private def refuse(reason: String): Nothing = throw Refused(s"$text: $reason")

object MujocoModel:
  /** Reads a model and measures its actuators: some 50 ms.
    *
    * @return
    *   or why it cannot be flown, or that MuJoCo is not here
    */
  def read(file: Path): Either[String, MujocoModel] =
    for
      _ <- MujocoLibrary.find
      _ <- Either.cond(Files.isRegularFile(file), (), s"expected a file of MuJoCo's XML, there is no $file")
      model <- load(file)
      read  <-
        try Right(MujocoModel(file.toString, model))
        catch
          case Refused(reason)         => Left(reason)
          case error: RuntimeException => Left(s"$file: ${error.getMessage}")
    yield read

  private[mujoco] def load(file: Path): Either[String, MemorySegment] =
    val arena = Arena.ofAuto()
    val error = arena.allocate(ErrorSize)
    val model = MujocoCalls.load(arena.allocateFrom(file.toString), error, ErrorSize.toInt)
    Either.cond(model.address != 0, model, s"$file: ${error.getString(0).trim}")

  private final case class Refused(reason: String) extends RuntimeException(reason)

  /** Signs of what each rotor does about the front and the right axis: front right, rear left, front left, rear right. */
  private val Corners = Vector((-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0))

  /** `mjJNT_FREE` */
  private val FreeJoint = 0

  private val HighM           = 1000.0
  private val SettlingS       = 2.0
  private val NotInProportion = 0.02
  private val ErrorSize       = 1000L

/** What the rotors' controls of AirSim's flight controller are to a model's actuators. AirSim's controller wants a thrust and
  * three torques of AirSim's quadrotor. The model gets the accelerations that these would give that one, with its weight in
  * the place of the other's: so AirSim's gains fly it, whatever its mass.
  */
private[mujoco] final class MujocoControls(model: MujocoModel):
  import MujocoControls.*

  private val values = Array.ofDim[Double](model.actuators)

  /** Overwritten by the next call.
    *
    * @param isDirect
    *   whether they are the rotors' own and not a controller's: then each is a share of its actuator's range
    */
  def of(state: QuadrotorState, isDirect: Boolean): Array[Double] =
    import state.{control0 as c0, control1 as c1, control2 as c2, control3 as c3}
    model.rotors match
      case Some(rotors) if isDirect =>
        set(rotors(0), c0); set(rotors(1), c1); set(rotors(2), c2); set(rotors(3), c3)
      case _ =>
        val up    = (c0 + c1 + c2 + c3) * UpByControl * model.weightMps2
        val front = (-c0 + c1 + c2 - c3) * FrontByControl
        val right = (c0 - c1 + c2 - c3) * RightByControl
        val down  = (c0 + c1 - c2 - c3) * DownByControl
        var i     = 0
        while i < values.length do
          val wanted = model.resting(i) + model.allocation.control(i, up, front, right, down)
          values(i) = math.max(model.lowest(i), math.min(wanted, model.highest(i)))
          i += 1
    values

  private def set(actuator: Int, share: Double): Unit =
    val top =
      if model.highest(actuator).isInfinite then model.resting(actuator) + 1 else model.highest(actuator)
    values(actuator) = model.resting(actuator) + share * (top - model.resting(actuator))

private[mujoco] object MujocoControls:
  private val airframe = Airframe()

  /** In air of sea level. */
  private[mujoco] val SeaLevel = Environment(originAltitudeM = 0)

  private val torque         = airframe.rotorOffsetM * airframe.maxThrustN
  private val UpByControl    = 1 / (4 * Quadrotor.AirSim.hoverControl(0, SeaLevel))
  private val FrontByControl = torque / airframe.inertiaFront
  private val RightByControl = torque / airframe.inertiaRight
  private val DownByControl  = airframe.maxTorqueNm / airframe.inertiaDown
