package skein.planning

import skein.lanes.LaneSupport
import skein.lanes.plant.PlantLanes
import skein.lanes.policy.PolicyLanes
import skein.policy.Policy
import skein.simd.WorldRandom
import skein.units.{eachBelow, eachFrom}
import skein.vehicle.Plant

/** Settings of a planner.
  *
  * @param steps number of steps of the horizon
  * @param dtS length of a step, s
  * @param elites number of a slice's candidates that count as the best
  * @param smoothing share of the search's old mean and deviation that is kept
  * @param blocksPerSlice number of blocks of 128 candidates in a slice, which is searched between two checks
  *   of the clock
  * @param stepsPerKnot number of steps that share one random turn
  * @param turnSd initial standard deviation of turn rates, rad/s
  * @param speedSd initial standard deviation of speeds, m/s
  */
final case class PlannerSettings(
    steps: Int = 20,
    dtS: Double = 0.1,
    elites: Int = 48,
    smoothing: Double = 0.2,
    blocksPerSlice: Int = 16,
    stepsPerKnot: Int = 4,
    turnSd: Double = 0.8,
    speedSd: Double = 2
):
  require(steps > 0 && dtS > 0, s"the horizon must be positive, got $steps steps of $dtS s")
  require(blocksPerSlice > 0 && stepsPerKnot > 0, "blocks per slice and steps per knot must be positive")
  require(elites > 0, s"expected one elite at least, got $elites")
  require(smoothing >= 0 && smoothing < 1, s"expected smoothing from 0 to below 1, got $smoothing")

  def horizonS: Double     = steps * dtS
  def sliceCandidates: Int = blocksPerSlice * CandidateBlock.Size

/** Plans manoeuvres by the cross-entropy method (Rubinstein, 1999), in which mean and deviation of the search
  * move towards those of the best candidates. A plan is improved slice by slice, and its manoeuvre is always
  * the best found. Equal plans, situations and streams give equal plans, to the last bit, on every machine.
  *
  * Holds the memory for a block of candidates: one per thread.
  */
final class Planner private[planning] (
    val settings: PlannerSettings,
    val objective: PlanCost,
    block: CandidateBlock
):
  import settings.*

  private val size       = CandidateBlock.Size
  private val limits     = objective.limits
  private val cruise     = math.min(limits.maxSpeed, math.max(limits.minSpeed, objective.cruiseSpeed))
  private val keys       = Array.ofDim[Int](size)
  private val eliteCosts = Array.ofDim[Float](elites)
  private val eliteTurns, eliteSpeeds = Array.ofDim[Float](eliteCosts.length * steps)

  /** The initial plan: straight on, with the initial deviations. */
  def start: Plan = around(Manoeuvre.straight(cruise, steps))

  /** The initial plan after some time: the remainder of the last, to be evaluated again. */
  def resumed(plan: Plan, elapsedS: Double): Plan = around(plan.manoeuvre.shifted(elapsedS, dtS))

  private def around(manoeuvre: Manoeuvre): Plan =
    val speedSds = if limits.minSpeed == limits.maxSpeed then 0f else speedSd.toFloat
    Plan(
      manoeuvre,
      Float.PositiveInfinity,
      SamplingDistribution(
        manoeuvre.turnRates,
        IArray.fill(steps)(turnSd.toFloat),
        manoeuvre.speeds,
        IArray.fill(steps)(speedSds)
      ),
      0,
      0
    )

  /** Searches one slice.
    *
    * @param stream number of the random stream: another stream draws other candidates
    */
  def improve(plan: Plan, situation: Situation, stream: Long): Plan =
    block.situate(situation, objective, dtS)
    java.util.Arrays.fill(eliteCosts, Float.PositiveInfinity)
    var best     = plan.manoeuvre
    var bestCost = plan.cost
    for number <- 0 until blocksPerSlice do
      for i <- 0 until size do
        keys(i) = WorldRandom.key(stream, plan.slices, number * size + i)
      val width = Planner.widths(number % Planner.widths.size)
      block.draw(keys, plan.search.narrowed(width), limits, stepsPerKnot)
      if number == 0 then (known(plan) ++ situation.suggested).zipWithIndex.foreach(put)
      block.fly()
      val least = cheapest
      if block.costs(least) < bestCost then
        bestCost = block.costs(least)
        best = manoeuvreAt(least)
      gatherElites()
    Plan(
      best,
      bestCost,
      eliteSearch(plan.search),
      plan.slices + 1,
      plan.candidates + blocksPerSlice.toLong * size
    )

  /** Manoeuvres that are always tried: the mean of the search, the best so far, and a few that a pilot would
    * try first.
    */
  private def known(plan: Plan): Vector[Manoeuvre] =
    val (speed, limit) = (plan.manoeuvre.speeds(0).toDouble, limits.turnRateAt(plan.manoeuvre.speeds(0)))
    Vector(
      Manoeuvre(plan.search.turnMeans, plan.search.speedMeans),
      plan.manoeuvre,
      Manoeuvre.steady(limit, speed, steps),
      Manoeuvre.steady(-limit, speed, steps),
      Manoeuvre.steady(0, speed, steps),
      Manoeuvre.steady(0, limits.minSpeed, steps),
      Manoeuvre.steady(0, limits.maxSpeed, steps)
    )

  private def put(manoeuvre: Manoeuvre, i: Int): Unit =
    for step <- 0 until steps do
      val speed = math.min(math.max(manoeuvre.speeds(step), limits.minSpeed.toFloat), limits.maxSpeed.toFloat)
      val limit = math.min(speed * limits.curvature.toFloat, limits.maxTurnRate.toFloat)
      block.turnRates(step * size + i) = math.min(math.max(manoeuvre.turnRates(step), -limit), limit)
      block.speeds(step * size + i) = speed

  private def cheapest: Int =
    var least = 0
    eachFrom(1, size): i =>
      if block.costs(i) < block.costs(least) then least = i
    least

  private def manoeuvreAt(i: Int): Manoeuvre =
    def column(values: Array[Float]): IArray[Float] =
      val of = Array.ofDim[Float](steps)
      for step <- 0 until steps do of(step) = values(step * size + i)
      IArray.unsafeFromArray(of)
    Manoeuvre(column(block.turnRates), column(block.speeds))

  private def gatherElites(): Unit =
    val (costs, turnRates, speeds)        = (block.costs, block.turnRates, block.speeds)
    val (elites, eliteTurns, eliteSpeeds) = (eliteCosts, this.eliteTurns, this.eliteSpeeds)
    var worst                             = indexOfWorst
    eachBelow(size): i =>
      if costs(i) < elites(worst) then
        elites(worst) = costs(i)
        eachBelow(steps): step =>
          eliteTurns(step * elites.length + worst) = turnRates(step * size + i)
          eliteSpeeds(step * elites.length + worst) = speeds(step * size + i)
        worst = indexOfWorst

  private def indexOfWorst: Int =
    val costs = eliteCosts
    var worst = 0
    eachFrom(1, costs.length): i =>
      if costs(i) > costs(worst) then worst = i
    worst

  private def eliteSearch(before: SamplingDistribution): SamplingDistribution =
    val kept                                                                    = smoothing.toFloat
    def moments(values: Array[Float], means: IArray[Float], sds: IArray[Float]) =
      val (newMeans, newSds) = (Array.ofDim[Float](steps), Array.ofDim[Float](steps))
      for step <- 0 until steps do
        val mean     = meanOverElites(elite => values(step * eliteCosts.length + elite))
        val variance = meanOverElites: elite =>
          val off = values(step * eliteCosts.length + elite) - mean
          off * off
        newMeans(step) = kept * means(step) + (1 - kept) * mean.toFloat
        newSds(step) = kept * sds(step) + (1 - kept) * math.sqrt(variance).toFloat
      (IArray.unsafeFromArray(newMeans), IArray.unsafeFromArray(newSds))
    val (turnMeans, turnSds)   = moments(eliteTurns, before.turnMeans, before.turnSds)
    val (speedMeans, speedSds) = moments(eliteSpeeds, before.speedMeans, before.speedSds)
    SamplingDistribution(turnMeans, turnSds, speedMeans, speedSds)

  private inline def meanOverElites(inline value: Int => Double): Double =
    var total = 0.0
    eachBelow(eliteCosts.length): elite =>
      total += value(elite)
    total / eliteCosts.length

object Planner:
  /** Scales of the search's deviations, by block: wide ones find other manoeuvres, narrow ones improve known
    * ones. With wide ones alone, a plan that is almost right is hardly ever improved.
    */
  private val widths = Vector(1f, 0.5f, 0.25f, 0.125f)

  def apply(settings: PlannerSettings, objective: PlanCost): Planner =
    new Planner(settings, objective, PlanKernel(settings.steps))

  /** Why plans against an opponent of this policy are not supported: for SIMD, it must be a formula. */
  def refusal(opponent: Policy): Option[String] =
    refusal(PolicyLanes.of(opponent).left.map(_.getMessage))

  /** Whether decisions of this policy, a formula, depend on its memory: a plan begins with the first. */
  def remembers(opponent: Policy): Boolean = PolicyLanes.get(opponent).remembered > 0

  /** Why plans for vehicles that move by this plant are not supported. */
  def refusal(plant: Plant[?]): Option[String] = refusal(PlantLanes.of(plant))

  private def refusal(compiled: => Either[String, Any]): Option[String] =
    LaneSupport.present.flatMap(_ => compiled).left.toOption
