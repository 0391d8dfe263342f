package skein.flight

import skein.loop.LoopKind
import skein.measure.FlightSummary
import skein.optimise.RunningStats
import skein.record.Recording
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*
import skein.units.Decimals.{fixed, signed}

/** Prints what plans in packets do for the paper's duel over links: the deviation of `predictive` from the
  * paused truth without and with them, by seed and as a mean with half of its 95 % interval. First as
  * reported, by tracks that lead straight through a time in which nothing was read; then by those moments of
  * the last 10 s alone at which both vehicles were read.
  *
  * {{{
  * ./sbtw "flight/Test/runMain skein.flight.packetFigures 12 loss:5%/4,outage:1s/10s,vpn"
  * }}}
  */
@main def packetFigures(seeds: Int, links: String*): Unit =
  given Scenarios                                                    = Scenarios.ours
  def settings(loop: LoopKind, link: LatencyProfile, plans: Boolean) = FlySettings(
    List(loop),
    List(link),
    duration = Span.ofSeconds(60),
    period = Span.ofMillis(100),
    seed = 1,
    planInPacket = plans
  )

  /** Mean distances of the last 10 s, as reported and by common readings, m. */
  def distances(recording: Recording): (Double, Double) =
    (FlightSummary.of(recording).headline.get, CommonReadings.distanceM(recording))

  def flown(of: FlySettings, seeds: Int) =
    val plans = Vector.tabulate(seeds)(number => of.plans.head.copy(seed = 1L + number))
    VirtualFlights.inParallel(of, plans)(flight => distances(flight.recorder.recording))

  val truths = flown(settings(LoopKind.Paused, LatencyProfile.none, plans = false), 1)
    .map(_.fold(missing => sys.error(missing.message), identity))
    .head
  println(s"truth ${truths._1.fixed(3)} m, ${truths._2.fixed(3)} m")
  for
    text  <- links
    plans <- Seq(false, true)
  do
    val link = LatencyProfile.parse(text, _ => Left("no file")).fold(no => sys.error(no.message), identity)
    val (missing, flew) = flown(settings(LoopKind.Predictive, link, plans), seeds).partitionMap(identity)
    missing.foreach(one => println(one.message))
    def told(which: ((Double, Double)) => Double) =
      val off   = flew.map(which(_) / which(truths) - 1).map(_ * 100)
      val stats = RunningStats.of(off.size)(off)
      s"${stats.mean.signed(1)} ± ${(1.96 * stats.sd / math.sqrt(off.size)).fixed(1)} %: " +
        off.map(_.signed(1)).mkString(", ")
    println(s"$text, plans $plans, as reported ${told(_._1)}")
    println(s"$text, plans $plans, where both were read ${told(_._2)}")
