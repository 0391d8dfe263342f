package skein.planning

import skein.vehicle.{PlaneReading, Plant, ReducedModel}

/** A [[ReducedModel]] with one lag, for steps much shorter than the lag. It uses the model's formulas, except
  * that the fraction of a velocity error that remains after a step, e^(−a), is computed as 1 − a · (1 − a/2 +
  * a²/6 − …), where a is the step times the rate of decay. The next term of the series is below 7e-6 for a up
  * to 0.5. A search evaluates 1.2 times as many candidates as with the exponential (`PlanBench`).
  */
private[planning] final case class ShortLagSteps(model: ReducedModel) extends Plant[PlaneReading]:
  import model.{dragPerM, gain, lagS}
  private val perLag = 1 / lagS
  private val brakes = dragPerM * lagS

  def initial: PlaneReading                   = model.initial
  def read(state: PlaneReading): PlaneReading = state
  def stepS: Double                           = lagS / ShortLagSteps.LeastOfLag

  def step(from: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
    import from.{eastMps as vy, northMps as vx}
    val speed  = math.sqrt(vx * vx + vy * vy)
    val a      = (perLag + dragPerM * speed) * dtS
    val slides = 1 + a * (-1.0 / 2 + a * (1.0 / 6 + a * (-1.0 / 24 + a * (1.0 / 120 + a * (-1.0 / 720)))))
    val (remains, carriesS) = (1 - a * slides, slides * dtS)
    val reached             = gain / (1 + brakes * speed)
    val (goalVx, goalVy)    = (northMps * reached, eastMps * reached)
    val (offVx, offVy)      = (vx - goalVx, vy - goalVy)
    PlaneReading(
      from.northM + goalVx * dtS + offVx * carriesS,
      from.eastM + goalVy * dtS + offVy * carriesS,
      goalVx + offVx * remains,
      goalVy + offVy * remains
    )

private[planning] object ShortLagSteps:
  private val LeastOfLag = 2.5

  def fits(model: ReducedModel, dtS: Double): Boolean =
    model.turnLagS == model.lagS && model.lagS >= LeastOfLag * dtS
