package skein.planning

import skein.policy.{ObservingPolicy, PlanarObservation}
import skein.vehicle.{PlaneReading, ReducedModel}

/** Flies one manoeuvre in a situation, in doubles: the reference for the kernel, the check of what is chosen, and how a
  * plan is told to others.
  *
  * Velocities follow commands as [[skein.vehicle.ReducedModel]] says, a piece per step, in which the command stands: the
  * heading has turned at its beginning.
  */
final class ManoeuvreRollout(situation: Situation, objective: PlanCost, dtS: Double):
  import ManoeuvreRollout.*

  /** What a manoeuvre comes to. */
  def fly(manoeuvre: Manoeuvre): ManoeuvreOutcome =
    val own      = Flyer(situation.own, situation.response, dtS)
    val steps    = manoeuvre.steps
    val way      = Array.ofDim[Motion](steps)
    val before   = Array.ofDim[Double](steps) // the heading commanded before the step
    var heading  = situation.headingRad
    var cost     = 0.0
    var breaches = Vector.empty[Breached]
    for step <- 0 until steps do
      val (turnRate, speed) = (manoeuvre.turnRates(step).toDouble, manoeuvre.speeds(step).toDouble)
      before(step) = heading
      heading += turnRate * (if step == 0 then situation.sinceDecisionS else dtS)
      own.fly(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading))
      way(step) = own.motion
      val slow  = speed - objective.cruiseSpeed
      val aside = turnRate * speed
      cost += (aside * aside * objective.turning + slow * slow * objective.speedChange) * dtS
      for geofence <- objective.geofences do
        val beyond = geofence.beyond(own.x, own.y)
        if beyond > 0 then breaches :+= Breached.Fence(step, beyond)
        if beyond + Guard > 0 then cost += Breach * (1 + beyond + Guard)
      for index <- situation.others.indices do
        val other    = situation.others(index)
        val distance = StrictMath.hypot(own.x - other.x(step), own.y - other.y(step))
        val missing  = objective.separation.clearance((step + 1) * dtS) - distance
        if missing > 0 then cost += missing * missing * objective.separation.price * dtS
        if distance < objective.separation.minimum then
          breaches :+= Breached.TooNear(step, index, distance)
        val short = objective.separation.minimum + Guard - distance
        if short > 0 then cost += Breach * (1 + short)
    for behaviour <- situation.behaviours do
      cost += behaviour.weight * distanceCost(behaviour.target, way, before)
    ManoeuvreOutcome(PredictedTrack(IArray.from(way.map(_.x)), IArray.from(way.map(_.y))), cost, breaches)

  private def distanceCost(
      target: Target,
      own: Array[Motion],
      before: Array[Double]
  ): Double =
    val steps                = own.length
    val lagS                 = situation.response.lagS
    val (tx, ty)             = (Array.ofDim[Double](steps), Array.ofDim[Double](steps))
    val (carriedX, carriedY) = target match
      case opponent: Target.Opponent =>
        val flyer   = Flyer(opponent.motion, opponent.response, dtS)
        var heading = opponent.headingRad
        var memory  = ObservingPolicy.initialOf(opponent.policy)
        for step <- 0 until steps do
          val last = if step == 0 then situation.own else own(step - 1)
          val seen = PlanarObservation(
            last.x - flyer.x,
            last.y - flyer.y,
            last.vx - flyer.vx,
            last.vy - flyer.vy,
            heading,
            before(step),
            dtS,
            0,
            0
          )
          val decided = ObservingPolicy.decide(opponent.policy, seen, memory)
          heading = decided.headingRad
          memory = decided.memory
          flyer.fly(opponent.speed * StrictMath.cos(heading), opponent.speed * StrictMath.sin(heading))
          tx(step) = flyer.x
          ty(step) = flyer.y
        (flyer.vx * opponent.response.lagS, flyer.vy * opponent.response.lagS)
      case along: Target.Along =>
        for step <- 0 until steps do
          tx(step) = along.track.x(step)
          ty(step) = along.track.y(step)
        (along.track.lastVx(dtS) * lagS, along.track.lastVy(dtS) * lagS)
    val distances = (0 until steps).map(step => soft(tx(step) - own(step).x, ty(step) - own(step).y))
    val least     = distances.min
    val end       = soft(
      tx(steps - 1) + carriedX - own.last.x - own.last.vx * lagS,
      ty(steps - 1) + carriedY - own.last.y - own.last.vy * lagS
    )
    distances.sum * dtS * objective.distance + least * objective.closest + end * objective.carried -
      (if least < objective.captureRadius then objective.capture else 0)

  private def soft(dx: Double, dy: Double): Double =
    StrictMath.hypot(StrictMath.hypot(dx, dy), objective.softness)

object ManoeuvreRollout:
  /** What one step costs that breaks a hard limit. */
  val Breach = 1000.0

  /** Within which hard limits count as broken already when candidates are priced, m: so that what floats find within
    * them is so in doubles.
    */
  val Guard = 0.01

  /** Added to squares of lengths before the root, m². */
  private[planning] val Tiny = 1e-12

  /** A vehicle under its commands, step by step. Mutable. */
  private[planning] final class Flyer(start: Motion, response: ReducedModel, dtS: Double):
    private var at = PlaneReading(start.x, start.y, start.vx, start.vy)

    def x: Double  = at.northM
    def y: Double  = at.eastM
    def vx: Double = at.northMps
    def vy: Double = at.eastMps

    def motion: Motion = Motion(x, y, vx, vy)

    def fly(commandedX: Double, commandedY: Double): Unit =
      at = response.step(at, commandedX, commandedY, dtS)

/** @param track
  *   of the vehicle itself
  * @param breaches
  *   of hard limits
  */
final case class ManoeuvreOutcome(track: PredictedTrack, cost: Double, breaches: Vector[Breached])

/** A hard limit broken at the end of a step. */
enum Breached:
  def step: Int

  /** @param metres
    *   outside
    */
  case Fence(step: Int, metres: Double)

  /** @param other
    *   which of the vehicles to keep apart from
    */
  case TooNear(step: Int, other: Int, metres: Double)
