package skein.planning

import skein.vehicle.{PlaneReading, ReducedModel}

class ShortLagStepsSuite extends munit.FunSuite:
  test("a short step agrees with the reduced model's step, within the truncated terms of the series"):
    for
      lagS     <- Seq(0.3, 1.0, 2.967)
      dragPerM <- Seq(0.0, 0.0067)
      speed    <- Seq(0.0, 4.0, 15.0)
      ofLag    <- Seq(0.01, 0.2, 0.4)
      model = ReducedModel(1.02, lagS, 0, lagS, dragPerM)
      dtS   = ofLag * lagS
      if ShortLagSteps.fits(model, dtS)
    do
      val from = PlaneReading(1, 2, 0.6 * speed, -0.8 * speed)
      val ours = ShortLagSteps(model).step(from, -3, 9, dtS)
      val own  = model.step(from, -3, 9, dtS)
      for ((one, other), i) <- ours.productIterator.zip(own.productIterator).zipWithIndex do
        val off = 7e-6 * (15 + speed) * (if i < 2 then dtS else 1)
        assertEqualsDouble(one.asInstanceOf[Double], other.asInstanceOf[Double], off, s"$model $dtS $speed")

  test("short-lag steps do not fit steps that are long relative to the lag, nor models with two lags"):
    assert(!ShortLagSteps.fits(ReducedModel.lag(1, 0.2, 0), 0.1))
    assert(!ShortLagSteps.fits(ReducedModel(1, 1, 0, 1.5, 0), 0.1))
