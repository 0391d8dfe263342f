package skein.measure

import skein.loop.LoopKind

/** The paper's figures, copied from it a second time: m; and ms of evader and pursuer for each observation.
  */
class PublishedSuite extends munit.FunSuite:

  private val paper =
    """paused     direct  8.53  8.41  8.62  3.75 5.9   0    0     0     0     100 100  100 100
      |sequential direct  12.3  4.9   16.9  3.9  5.9   32   0.2   0.04  32    168 168  168 143
      |futures    direct  9.83  9.54  10.49 3.93 5.8   40   0.02  0.04  40    137 133  81  88
      |stream     direct  9.31  9.02  9.68  3.78 6     26   25    25    26    79  79   81  73
      |sequential vpn     40.5  26.9  47.9  1.9  -     97   0.2   0.06  97    284 284  284 236
      |futures    vpn     24.2  4.5   33.1  3.5  6.2   118  0.03  0.06  116   198 179  129 140
      |stream     vpn     8.5   5     11.6  3.45 6     35   34    34    35    65  64   66  61""".stripMargin

  private val rows = paper.linesIterator.map(_.split(" +").toVector).toVector

  test("every published flight has the paper's distances and the paper's observations by role"):
    assertEquals(Published.flights.size, rows.size)
    for case Vector(loop, link, figures*) <- rows do
      val kind   = LoopKind.parse(loop).toOption.getOrElse(fail(s"no loop $loop"))
      val flight = Published.flight(kind, link).getOrElse(fail(s"no $loop over $link"))
      val Seq(mean, least, most, closest, at, observed*) = figures.map(_.toDoubleOption): @unchecked
      val distance                                       = flight.distance.getOrElse(fail("no distance"))
      assertEquals(
        Seq(
          distance.mean,
          distance.least,
          distance.most,
          distance.closest
        ).map(Some(_)) :+ distance.closestAtS,
        Seq(mean, least, most, closest, at),
        s"$loop over $link"
      )
      val roles = Seq("evader", "pursuer")
      val told  =
        for observation <- TimingObservation.values.toSeq; role <- roles
        yield Published.ofRole(flight.observedMs(observation), role)
      assertEquals(told.map(Some(_)), observed, s"$loop over $link")

  test("the paper's paused flight is comparable over any link, other flights over their own"):
    assertEquals(Published.flight(LoopKind.Paused, "vpn").map(_.link), Some("direct"))
    assertEquals(Published.flight(LoopKind.Futures, "none"), None)
    assertEquals(Published.flight(LoopKind.Futures, "vpn").map(_.loop), Some(LoopKind.Futures))
