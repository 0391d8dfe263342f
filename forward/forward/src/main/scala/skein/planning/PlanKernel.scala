package skein.planning

import java.util.Arrays
import skein.simd.FixedFormula
import skein.units.eachBelow

/** Simulates many candidate manoeuvres of one vehicle with SIMD and computes their costs. The code is
  * compiled from the formulas of [[ManoeuvreRollout]], the scalar reference; `PlanKernelSuite` compares the
  * two. The vehicle's track does not depend on its opponent; so it is simulated once, and then priced against
  * every behaviour of the opponent.
  *
  * Positions are relative to the vehicle's start, where floats are finest. Results do not depend on the lane
  * count. One instance per thread.
  */
private[planning] final class PlanKernel(steps: Int) extends SampledBlock(steps):
  import PlanKernel.*
  import VehicleLanes.{Apart, row}

  private var flown       = Option.empty[(Situation, PlanCost, Double)]
  private var geofences   = Vector.empty[Geofence]
  private val own, target = VehicleLanes(steps)
  private var opponents   = Vector.empty[OpponentLanes]
  private val cos, sin    = Array.ofDim[Float]((steps + 1) * Size) // headed before each step
  private val north, east = Array.ofDim[Float](Size)
  // The present row and the next row of these.
  private val heading, effort, sum, nearest = Array.ofDim[Float](2 * Size)
  private val lastRow                       = steps % 2 * Size
  private var cost, nextCost                = Array.ofDim[Float](Size)

  private val steered = Compiled("steered", alike = 2): call =>
    for (values, i) <- Seq(effort, heading).zipWithIndex do
      call.rows(i, values, 0, Size)
      call.outputRows(i, values, Size, Size)
    call.rows(2, turnRates, 0, Size)
    call.rows(3, speeds, 0, Size)
    call.outputRows(2, cos, Size, Size)
    call.outputRows(3, sin, Size, Size)
    call.output(4, north, 0)
    call.output(5, east, 0)
  private val inside = Compiled("added", alike = 0): call =>
    for axis <- 0 to 1 do call.rows(1 + axis, own.way, row(1, axis), Apart)
  private val neared     = Compiled("neared", alike = 4)(_ => ())
  private val approached = Compiled("approached", alike = 0): call =>
    for (values, i) <- Seq(sum, nearest).zipWithIndex do
      call.rows(i, values, 0, Size)
      call.outputRows(i, values, Size, Size)
    for (vehicle, first) <- Seq(own -> 2, target -> 4); axis <- 0 to 1 do
      call.rows(first + axis, vehicle.way, row(1, axis), Apart)
  private val ended = Compiled("ended", alike = 4): call =>
    for (values, i) <- Seq(sum, nearest).zipWithIndex do call.input(1 + i, values, lastRow)
    for (vehicle, first) <- Seq(own -> 3, target -> 7); number <- 0 to 3 do
      call.input(first + number, vehicle.way, row(steps, number))

  def situate(situation: Situation, objective: PlanCost, dtS: Double): Unit =
    flown = Some((situation, objective, dtS))
    val origin = situation.own.motion
    geofences = objective.geofences.map(_.from(origin.northM, origin.eastM))
    val behaviours = situation.behaviours
    opponents ++= Vector.fill(behaviours.size - opponents.size)(OpponentLanes(steps))
    for case (Behaviour(opponent: Target.Opponent, _), i) <- behaviours.zipWithIndex do
      opponents(i).take(opponent)

  def fly(): Unit = for (situation, objective, dtS) <- flown do
    val origin = situation.own.motion
    own.take(situation.own, origin, dtS)
    steer(situation, objective, dtS)
    for geofence <- geofences do stayInside(geofence)
    if situation.others.nonEmpty then keepApart(situation, objective, dtS)
    for (Behaviour(to, weight), i) <- situation.behaviours.zipWithIndex do
      to match
        case _: Target.Opponent  => opponents(i).fly(own, cos, sin, origin, dtS, target)
        case Target.Along(track) => target.follow(track, origin, dtS)
      val carriesS = situation.own.carriesS
      score(objective, carriesS, to.carriesS.getOrElse(carriesS), weight, dtS)
    System.arraycopy(cost, 0, costs, 0, Size)

  private def steer(situation: Situation, objective: PlanCost, dtS: Double): Unit =
    val steer = steered.of(objective)
    Arrays.fill(effort, 0, Size, 0f)
    Arrays.fill(heading, 0, Size, situation.headingRad.toFloat)
    Arrays.fill(cos, 0, Size, StrictMath.cos(situation.headingRad).toFloat)
    Arrays.fill(sin, 0, Size, StrictMath.sin(situation.headingRad).toFloat)
    steer.everywhere(4, situation.firstTurnS.toFloat)
    steer.everywhere(5, dtS.toFloat)
    eachBelow(steps): _ =>
      steer.next()
      steer.everywhere(4, dtS.toFloat)
      own.fly(north, east, 1)
    System.arraycopy(effort, lastRow, cost, 0, Size)

  private def stayInside(geofence: Geofence): Unit =
    val stay = inside.of(geofence)
    eachBelow(steps)(_ => add(stay))

  private def keepApart(situation: Situation, objective: PlanCost, dtS: Double): Unit =
    val origin = situation.own.motion
    val keep   = neared.of(objective)
    keep.everywhere(6, dtS.toFloat)
    for step <- 0 until steps do
      for axis <- 0 to 1 do keep.input(1 + axis, own.way, row(step + 1, axis))
      keep.everywhere(5, objective.separation.clearance((step + 1) * dtS).toFloat)
      for other <- situation.others do
        keep.everywhere(3, (other.x(step) - origin.northM).toFloat)
        keep.everywhere(4, (other.y(step) - origin.eastM).toFloat)
        add(keep)

  private def score(
      objective: PlanCost,
      carriesS: Double,
      targetCarriesS: Double,
      weight: Double,
      dtS: Double
  ): Unit =
    val approach = approached.of(objective)
    Arrays.fill(sum, 0, Size, Approach.none.sum.toFloat)
    Arrays.fill(nearest, 0, Size, Approach.none.least.toFloat)
    eachBelow(steps)(_ => approach.next())
    val end = ended.of(objective)
    end.everywhere(11, carriesS.toFloat)
    end.everywhere(12, targetCarriesS.toFloat)
    end.everywhere(13, weight.toFloat)
    end.everywhere(14, dtS.toFloat)
    add(end)

  private def add(formula: FixedFormula.Call): Unit =
    formula.input(0, cost, 0)
    formula.output(0, nextCost, 0)
    formula.next()
    val before = cost
    cost = nextCost
    nextCost = before

private object PlanKernel:
  private final val Size = CandidateBlock.Size

  /** A compiled method of the object that was passed last.
    *
    * @param alike number of the last arguments that are equal for all candidates
    * @param bind sets the arrays of a call
    */
  private final class Compiled(method: String, alike: Int)(bind: FixedFormula.Call => Unit):
    private var known = Option.empty[(formula: FixedFormula, call: FixedFormula.Call)]
    private var last  = Option.empty[AnyRef]

    def of(target: AnyRef): FixedFormula.Call =
      if !last.exists(_ eq target) then
        known match
          case Some((formula, call)) if formula.fits(target) => call.take(target)
          case _                                             =>
            val formula = FixedFormula.of(target, method, alike).fold(throw _, identity)
            val call    = formula.call(target)
            bind(call)
            known = Some((formula, call))
        last = Some(target)
      val call = known.get.call
      call.rewind()
      call
