package skein.vehicle

import skein.signal.SplitMix64

class ParameterBeliefSuite extends munit.FunSuite:
  private val priors = Vector(2.0, 1.0)

  test("after many measurements of a linear process the parameters are known, within the stated uncertainty"):
    val truth  = Vector(1.5, -0.4)
    val random = SplitMix64(3)
    val after  = (1 to 400).foldLeft(ParameterBelief(priors)): (belief, _) =>
      val effects = Vector(random.nextDouble() - 0.5, random.nextDouble() - 0.5)
      val noise   = 0.1 * (random.nextDouble() + random.nextDouble() - 1) * math.sqrt(6)
      val error   = effects.zip(truth.zip(belief.mean)).map((h, pair) => h * (pair._1 - pair._2)).sum + noise
      belief.updated(effects, error, 0.1)
    for i <- truth.indices do
      val deviation = math.sqrt(after.covariance(i)(i))
      assert(deviation < 0.03, after)
      assert((after.mean(i) - truth(i)).abs < 4 * deviation, after)

  test("one measurement distributes the error among the parameters by their variances and effects"):
    val after = ParameterBelief(priors).updated(Vector(1, 1), error = 3, noise = 1)
    // Variances 4 and 1, noise 1: gains 4/6 and 1/6.
    assertEqualsDouble(after.mean(0), 2, 1e-12)
    assertEqualsDouble(after.mean(1), 0.5, 1e-12)
    assertEqualsDouble(after.covariance(0)(0), 4 - 16.0 / 6, 1e-12)
    assertEqualsDouble(after.covariance(0)(1), -4.0 / 6, 1e-12)

  test("the uncertainty increases with time, up to its initial value"):
    val known = ParameterBelief(priors).updated(Vector(1, 0), 0, 0.01)
    val later = known.drifted(Vector(0.5, 0.5), s = 4, priors)
    assertEqualsDouble(later.covariance(0)(0), known.covariance(0)(0) + 1, 1e-12)
    assertEqualsDouble(later.covariance(1)(1), 1, 1e-12)
    assertEqualsDouble(known.drifted(Vector(9, 9), 9, priors).covariance(0)(0), 4, 1e-9)
