package skein.planning

/** Simulates the candidates of [[PlanKernel]] one by one: its reference. */
private[planning] final class ScalarBlock(steps: Int) extends CandidateBlock(steps):
  private val size = CandidateBlock.Size

  private var rollout: Option[ManoeuvreRollout] = None

  def situate(situation: Situation, objective: PlanCost, dtS: Double): Unit =
    rollout = Some(ManoeuvreRollout(situation, objective, dtS))

  def draw(keys: Array[Int], from: SamplingDistribution, limits: CommandLimits, stepsPerKnot: Int): Unit =
    for i <- 0 until size; step <- 0 until steps do
      val knot  = step / stepsPerKnot
      val speed = within(
        Math.fma(Draws.normal(keys(i), 2 * knot + 1), from.speedSds(step), from.speedMeans(step)),
        limits.minSpeed.toFloat,
        limits.maxSpeed.toFloat
      )
      val limit = math.min(speed * limits.curvature.toFloat, limits.maxTurnRate.toFloat)
      val turn  = Math.fma(Draws.normal(keys(i), 2 * knot), from.turnSds(step), from.turnMeans(step))
      turnRates(step * size + i) = within(turn, -limit, limit)
      speeds(step * size + i) = speed

  private def within(value: Float, least: Float, most: Float): Float = math.min(math.max(value, least), most)

  def fly(): Unit =
    for
      way <- rollout
      i   <- 0 until size
    do costs(i) = way.fly(manoeuvre(i)).cost.toFloat

  private def manoeuvre(i: Int): Manoeuvre =
    Manoeuvre(
      IArray.tabulate(steps)(step => turnRates(step * size + i)),
      IArray.tabulate(steps)(step => speeds(step * size + i))
    )
