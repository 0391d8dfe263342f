package skein.mujoco

import skein.units.Decimals.brief
import skein.units.Expect
import skein.vehicle.ControllerGains

/** A model's body, as measured.
  *
  * @param stepS duration of a step, s
  * @param place the part of a row that holds the body's position and attitude; likewise the next ones
  * @param standsAtM the body's height in the model when it stands on the ground, m
  * @param hoveringRow state after a long hover
  * @param standingRow state on the ground
  */
private[mujoco] final class MujocoBody(
    val stepS: Double,
    val place: MujocoBatch.Part,
    val velocity: MujocoBatch.Part,
    val controls: MujocoBatch.Part,
    val time: MujocoBatch.Part,
    val standsAtM: Double,
    val actuators: MujocoActuators,
    val hoveringRow: Array[Double],
    val standingRow: Array[Double]
)

/** Measures whether and how a model can fly: each actuator is held at a control until it has settled, and the
  * accelerations are read.
  *
  * @param one a simulation of the model
  */
private[mujoco] final class MujocoMeasuring(one: MujocoBatch):
  import MujocoBatch.*
  import MujocoMeasuring.*

  private val place    = one.part(Positions)
  private val velocity = one.part(Velocities)
  private val controls = one.part(Controls)
  private val time     = one.part(Time)
  private val count    = controls.size
  private val stepS    = one.doubles("opt.timestep").head

  private val initial: Vector[Double] =
    one.reset()
    one.rowOf(0).toVector

  /** The body's initial height in the model, m. */
  private def standsAtM = initial(place.at + 2)

  private val limited = one.flags("actuator_ctrllimited")
  private val ranges  = one.doubles("actuator_ctrlrange")
  private val lowest  =
    Array.tabulate(count)(i => if limited(i) then ranges(2 * i) else Double.NegativeInfinity)
  private val highest =
    Array.tabulate(count)(i => if limited(i) then ranges(2 * i + 1) else Double.PositiveInfinity)
  private val resting = Array.tabulate(count)(i => 0.0.max(lowest(i)).min(highest(i)))

  /** The measured body, or why it cannot fly. */
  def body: Either[String, MujocoBody] =
    for
      _ <- expect(place.size >= 7 && one.ints("jnt_type").head == FreeJoint)(
        "the vehicle's free joint to be the first joint"
      )
      _ <- expect(count >= 4)(s"at least 4 actuators, got $count")
      falling = accelerations(resting)
      effects    <- Expect.each(0 until count)(effectOf(_, falling))
      _          <- expect(falling(0) < 0)("gravity along −z")
      allocation <- Allocation.of(Array.tabulate(4, count)((axis, actuator) => effects(actuator)(axis)))
      actuators = MujocoActuators(lowest, highest, resting, effects, -falling(0), allocation)
      hovering  = actuators.hovering
      _ <- Expect.each(0 until count): i =>
        expect(hovering(i) >= lowest(i) && hovering(i) <= highest(i))(
          s"a control range with ${hovering(i)}, by which it hovers, got ${lowest(i)} to ${highest(i)}"
        ).left.map(named(i))
      _ <- Expect.each(Needed): (axis, name, needed) =>
        val came = actuators.turning(axis)
        expect(came >= needed)(
          s"moments that turn it about its $name axis by ${needed.brief} rad/s² or more while it hovers, " +
            s"got ${came.brief} rad/s²: ${(needed / came).brief} times as much is needed"
        )
    yield MujocoBody(
      stepS,
      place,
      velocity,
      controls,
      time,
      standsAtM,
      actuators,
      settled(hovering),
      settled(resting)
    )

  private def named(actuator: Int)(reason: String) = s"actuator $actuator: $reason"

  /** Change of the accelerations per unit of an actuator's control. */
  private def effectOf(actuator: Int, falling: Array[Double]): Either[String, Array[Double]] =
    val rest              = resting(actuator)
    val full              = if highest(actuator).isInfinite then rest + 1 else highest(actuator)
    val way               = full - rest
    def at(share: Double) =
      accelerations(resting.updated(actuator, rest + share * way)).zip(falling).map((a, b) =>
        (a - b) / (share * way)
      )
    (for
      _ <- expect(way > 0)(s"a control range above $rest")
      (half, whole) = (at(0.5), at(1))
      greatest      = whole.map(math.abs).max
      _ <- expect(half.zip(whole).forall((a, b) => !(math.abs(a - b) > NotInProportion * greatest)))(
        "a force in proportion to its control"
      )
    yield whole).left.map(named(actuator))

  /** Accelerations at rest, level and far above everything: upwards, m/s², about front, right and down,
    * rad/s².
    */
  private def accelerations(told: Array[Double]): Array[Double] =
    one.setRow(0, settled(told))
    for i <- 0 until velocity.size do one(0, velocity.at + i) = 0
    one(0, place.at + 2) = HighM
    one.mark(0)
    one.step()
    def change(index: Int) = one(0, velocity.at + index) / stepS
    Array(change(2), change(3), -change(4), -change(5))

  /** The state after being held in place until the actuators have settled. */
  private def settled(told: Array[Double]): Array[Double] =
    one.reset()
    val held = initial.toArray
    held(place.at + 2) = HighM
    for i <- told.indices do held(controls.at + i) = told(i)
    one.setRow(0, held)
    for _ <- 0 until (SettlingS / stepS).ceil.toInt do
      one.mark(0)
      one.step()
      for part <- Seq(place, velocity); i <- part.at until part.at + part.size do one(0, i) = held(i)
    one(0, place.at + 2) = standsAtM
    one(0, time.at) = 0
    one.rowOf(0)

private object MujocoMeasuring:
  private def expect(holds: Boolean)(what: => String): Either[String, Unit] =
    Expect.that(holds)(s"expected $what")

  /** MuJoCo's number of a free joint, `mjJNT_FREE`. */
  private val FreeJoint = 0

  private val gains = ControllerGains()

  /** For each axis: its index, its name, and the least angular acceleration that the actuators must reach,
    * rad/s².
    *
    * AirSim's controller turns a vehicle at up to `maxRate` ω. About the front and the right axis it begins
    * to brake 1/`angleP` before the angle that it wants, since its rate goal is ω·`angleP`·error. An
    * acceleration a stops the turn within ω²/2a. With less than a = ω²·`angleP`/2 (7.8 rad/s²) the vehicle
    * turns farther than the controller wants, it corrects too late, and swings; far below it falls. About the
    * down axis nothing keeps it in the air, and headings are a circle: the turn has to end within half of it,
    * a = ω²/2π (1.0 rad/s²), or the nearer way is never the right one.
    */
  private val Needed = Vector(
    (1, "front", gains.maxRate * gains.maxRate * gains.angleP / 2),
    (2, "right", gains.maxRate * gains.maxRate * gains.angleP / 2),
    (3, "down", gains.maxRate * gains.maxRate / (2 * math.Pi))
  )

  private val HighM           = 1000.0
  private val SettlingS       = 2.0
  private val NotInProportion = 0.02
