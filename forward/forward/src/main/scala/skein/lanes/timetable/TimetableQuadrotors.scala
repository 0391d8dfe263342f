package skein.lanes.timetable

import skein.formula.Trace
import skein.forward.RolloutAgent
import skein.lanes.plant.LaneQuadrotors
import skein.lanes.policy.{Directions, LaneObservation}
import skein.simd.{BoundFunction, LaneCall}

/** Quadrotors with their flight controllers. They move in whole steps: a command takes effect at the first
  * step after its arrival, and between steps a vehicle is extrapolated with constant acceleration. Their
  * clock represents a time by the number of steps since the last event, and by the time since the last step.
  * Positions are relative to the start, where floats are finest. The scalar reference is
  * `skein.forward.QuadrotorVehicle`.
  */
private[lanes] final class TimetableQuadrotors(agent: RolloutAgent, flown: LaneQuadrotors)
    extends TimetableVehicles(agent):
  import TimetableQuadrotors.*
  import LaneObservation.{VX, VY, X, Y}
  import TimetableVehicles.WORLDS
  private val hold     = flown.holdingAt(agent.altitudeDownM)
  private val carried  = Array.ofDim[Float](2)
  private val position = LaneCall(placed, carried)
  private val velocity = LaneCall(moved, carried)

  def start(worlds: Int): Unit =
    flown.use(worlds)
    position.use(worlds)
    velocity.use(worlds)
    for world <- 0 until WORLDS do rest(world, 0)

  def rest(world: Int, headingRad: Float): Unit = flown.hover(world, hold)

  def look(times: Array[Float], at: Int, into: Int, withVelocity: Boolean): Unit =
    flown.fly(times(at).toInt)
    val sinceS = times(at + 1)
    carried(0) = sinceS
    carried(1) = sinceS * sinceS / 2
    look(flown.X, flown.VX, flown.AX, startX, seen(X), into)
    look(flown.Y, flown.VY, flown.AY, startY, seen(Y), into)
    if withVelocity then
      lookAtVelocity(flown.VX, flown.AX, seen(VX), into)
      lookAtVelocity(flown.VY, flown.AY, seen(VY), into)

  private def look(x: Int, v: Int, a: Int, start: Array[Float], seen: Array[Float], into: Int): Unit =
    position.input(0, flown.state, a)
    position.input(1, flown.state, v)
    position.input(2, flown.state, x)
    position.input(3, start, 0)
    position.output(0, seen, into)
    position()

  private def lookAtVelocity(v: Int, a: Int, seen: Array[Float], into: Int): Unit =
    velocity.input(0, flown.state, a)
    velocity.input(1, flown.state, v)
    velocity.output(0, seen, into)
    velocity()

  def act(times: Array[Float], at: Int, commanded: Directions, from: Int): Unit =
    flown.fly(times(at).toInt)
    flown.command(commanded, from, agent.speed.toFloat, agent.altitudeDownM.toFloat)

private[lanes] object TimetableQuadrotors:
  private val trace = Trace()
  import trace.{add, input, mul, param}

  /** Computes the extrapolated position from acceleration, velocity, position and start. Parameters are the
    * time since the last step, and half its square.
    */
  val placed: BoundFunction = BoundFunction.of(
    Vector(add(add(add(mul(input(0), param(1)), mul(input(1), param(0))), input(2)), input(3)))
  )

  val moved: BoundFunction = BoundFunction.of(Vector(add(mul(input(0), param(0)), input(1))))
