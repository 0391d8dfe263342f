package skein.optimise

import skein.optimise.LatencyBudget.Bound
import skein.signal.LatencyDistribution

class LatencyBudgetSuite extends munit.FunSuite:
  test("a cell's link has the mean and the jitter of the cell"):
    for (mean, jitter) <- Seq((40.0, 20.0), (100.0, 66.0), (200.0, 5.0), (30.0, 90.0)) do
      val link = LatencyBudget.link(mean, jitter).get
      assertEqualsDouble(link.mean.toMillis, mean, 1e-3)
      assertEqualsDouble(link.jitter.toMillis, jitter, 1e-3)
    assertEquals(LatencyBudget.link(50, 0).map(_.jitter.toMillis), Some(0.0))

  test("no link has jitter without latency, or a jitter far above its mean"):
    assertEquals(LatencyBudget.link(0, 10), None)
    assertEquals(LatencyBudget.link(10, 90), None)

  private def budget(values: Vector[Option[Double]]): LatencyBudget = LatencyBudget(
    Vector(0.0, 20.0, 40.0, 60.0),
    Vector(0.0),
    Vector(values.map(_.map(RunningStats(1, _, 0)))),
    truth = 10,
    per = 10
  )

  test("the bound lies where the straight line between two cells leaves the tolerance"):
    val map = budget(Vector(Some(10.0), Some(10.2), Some(10.8), Some(12.0)))
    assertEquals(map.holdsUpTo(0, 0.5), Bound.Beyond(60))
    map.holdsUpTo(0, 0.05) match
      case Bound.At(meanMs) => assertEqualsDouble(meanMs, 30, 1e-9)
      case other            => fail(s"$other")

  test("from more to less than the truth, the bound lies where the line leaves on the other side"):
    budget(Vector(Some(10.0), Some(10.4), Some(8.0), None)).holdsUpTo(0, 0.05) match
      case Bound.At(meanMs) => assertEqualsDouble(meanMs, 20 + 20 * 0.9 / 2.4, 1e-9)
      case other            => fail(s"$other")

  test("a bound before the first cell, or without any cell, is reported as such"):
    assertEquals(budget(Vector(None, Some(8.0), Some(10.0), None)).holdsUpTo(0, 0.05), Bound.Below(20))
    assertEquals(budget(Vector.fill(4)(None)).holdsUpTo(0, 0.05), Bound.Unknown)

  test("the tolerance does not hold where the objective has no finite value"):
    val nowhere = Some(Double.NaN)
    assertEquals(budget(Vector.fill(4)(nowhere)).holdsUpTo(0, 0.05), Bound.Below(0))
    assertEquals(budget(Vector(Some(10.0), Some(10.0), nowhere, nowhere)).holdsUpTo(0, 0.05), Bound.At(20))

  test("the paper's links have their measured jitter"):
    assertEqualsDouble(LatencyDistribution.Direct.jitter.toMillis, 58.3 - 35.9, 1e-6)
    assertEqualsDouble(LatencyDistribution.Vpn.jitter.toMillis, 165.5 - 99.4, 1e-6)
