package skein.planning

import skein.policy.{Observation, Seen}
import skein.signal.Kinematics
import skein.units.*
import skein.units.Decimals.{fixed, significant}
import skein.vehicle.PlaneReading

/** Simulates one manoeuvre in a situation, in doubles: the reference for the kernel, the check of the chosen
  * plan, and the track that other vehicles' plans use.
  *
  * Vehicles follow their commands by their plants; a command lasts one step. The heading turns at the step's
  * beginning.
  */
final class ManoeuvreRollout(situation: Situation, objective: PlanCost, dtS: Double):

  /** The track along which a manoeuvre leads. */
  def track(manoeuvre: Manoeuvre): PredictedTrack = track(flown(manoeuvre)._2)

  private def track(motions: Array[PlaneReading]): PredictedTrack =
    val (xs, ys) = (Array.ofDim[Double](motions.length - 1), Array.ofDim[Double](motions.length - 1))
    for step <- xs.indices do
      xs(step) = motions(step + 1).northM
      ys(step) = motions(step + 1).eastM
    PredictedTrack(IArray.unsafeFromArray(xs), IArray.unsafeFromArray(ys))

  /** Simulates a manoeuvre: its track, cost and breaches. */
  def fly(manoeuvre: Manoeuvre): FlownManoeuvre =
    val (commanded, motions) = flown(manoeuvre)
    val track                = this.track(motions)
    val carriesS             = situation.own.carriesS
    var cost                 = commanded.last.cost
    var breaches             = Vector.empty[Breached]
    for step <- 0 until manoeuvre.steps do
      val (x, y) = (track.x(step), track.y(step))
      val aheadS = (step + 1) * dtS
      for geofence <- objective.geofences do
        val beyond = geofence.fence.beyondM(x, y)
        if beyond > 0 then breaches :+= Breached.Fence(aheadS, beyond)
        cost = geofence.added(cost, x, y)
      for index <- situation.others.indices do
        val other     = situation.others(index)
        val distance  = StrictMath.hypot(x - other.x(step), y - other.y(step))
        val clearance = objective.separation.clearance(aheadS)
        val lacking   = objective.separation.minimum - objective.separation.doubt - distance
        if lacking > 0 then breaches :+= Breached.TooNear(aheadS, index, lacking)
        cost = objective.neared(cost, x, y, other.x(step), other.y(step), clearance, dtS)
    for Behaviour(target, weight) <- situation.behaviours do
      val theirs = meeting(target, commanded, motions)
      val came   = theirs.indices.foldLeft(Approach.none): (so, step) =>
        objective.approached(so, track.x(step), track.y(step), theirs(step).northM, theirs(step).eastM)
      cost = objective.ended(
        cost,
        came,
        motions.last,
        theirs.last,
        carriesS,
        target.carriesS.getOrElse(carriesS),
        weight,
        dtS
      )
    FlownManoeuvre(track, cost, breaches)

  /** The commands and the vehicle's motion, at the beginning and at the end of each step. */
  private def flown(manoeuvre: Manoeuvre): (Array[Steered], Array[PlaneReading]) =
    val commanded                = Array.ofDim[Steered](manoeuvre.steps + 1)
    val motions                  = Array.ofDim[PlaneReading](manoeuvre.steps + 1)
    var own: PredictedVehicle[?] = situation.own
    commanded(0) = Steered(0, situation.headingRad, 0, 0, 0, 0)
    motions(0) = own.motion
    for step <- 0 until manoeuvre.steps do
      val before            = commanded(step)
      val turnS             = if step == 0 then situation.firstTurnS else dtS
      val (turnRate, speed) = (manoeuvre.turnRates(step), manoeuvre.speeds(step))
      val now               = objective.steered(before.cost, before.headingRad, turnRate, speed, turnS, dtS)
      own = own.flown(now.northMps, now.eastMps, dtS)
      commanded(step + 1) = now
      motions(step + 1) = own.motion
    (commanded, motions)

  /** The target's motion at the end of each step. */
  private def meeting(
      target: Target,
      commanded: Array[Steered],
      own: Array[PlaneReading]
  ): IndexedSeq[PlaneReading] =
    target match
      case Target.Along(track) =>
        val (vx, vy) = (track.lastVx(dtS), track.lastVy(dtS))
        Vector.tabulate(track.steps)(step => PlaneReading(track.x(step), track.y(step), vx, vy))
      case Target.Opponent(start, speed, headingRad, policy) =>
        var (heading, memory, now) = (headingRad, policy.start, start: PredictedVehicle[?])
        for step <- 0 until own.length - 1 yield
          val (last, at) = (own(step), now.motion)
          val observed   = Observation(
            self = 0,
            Vector(seen(at), seen(last)),
            opponent = 1,
            Vector(Radians(heading), Radians(commanded(step).headingRad)),
            Span.ofSeconds(dtS),
            decisions = step,
            MetresPerSecond(speed),
            startDown = Metres(0)
          )
          val (action, next) = policy.choose(observed, memory)
          heading = action.headingRad(heading)
          memory = next
          now = now.flown(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading), dtS)
          now.motion

  private def seen(motion: PlaneReading) = Seen(
    Kinematics(
      Vector3(motion.northM, motion.eastM, 0),
      Vector3(motion.northMps, motion.eastMps, 0),
      Quaternion.Identity,
      Vector3.Zero
    ),
    Span.Zero,
    isPredicted = false
  )

/** A simulated manoeuvre with its cost.
  *
  * @param track the vehicle's own track
  * @param breaches breaches of hard limits, without the margins of plans
  */
final case class FlownManoeuvre(track: PredictedTrack, cost: Double, breaches: Vector[Breached])

/** A breach of a hard limit at the end of a step. */
enum Breached:
  /** Time from the plan's begin to the step's end, s. */
  def aheadS: Double

  /** Outside of a geofence.
    *
    * @param metres distance beyond the boundary, m
    */
  case Fence(aheadS: Double, metres: Double)

  /** Too near to another vehicle.
    *
    * @param other index in [[Situation.others]]
    * @param metres what the distance lacks to the separation, m
    */
  case TooNear(aheadS: Double, other: Int, metres: Double)

  def text: String =
    val what = this match
      case Fence(_, metres)      => s"${metres.fixed(2)} m outside of the geofence"
      case TooNear(_, _, metres) => s"${metres.fixed(2)} m nearer to another vehicle than the separation"
    s"$what, ${aheadS.significant(3)} s ahead"
