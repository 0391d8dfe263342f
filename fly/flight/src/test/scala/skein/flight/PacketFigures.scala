package skein.flight

import skein.loop.LoopKind
import skein.measure.FlightSummary
import skein.optimise.RunningStats
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*
import skein.units.Decimals.{fixed, signed}

/** Prints the effect of plans in packets on the paper's duel over links: the deviation of `predictive` from
  * the paused flight without and with them, by seed and as a mean with half of its 95 % interval.
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

  def flown(of: FlySettings, seeds: Int) =
    val plans = Vector.tabulate(seeds)(number => of.plans.head.copy(seed = 1L + number))
    VirtualFlights.inParallel(of, plans)(flight => FlightSummary.of(flight.recorder.recording).headline.get)

  val truth = flown(settings(LoopKind.Paused, LatencyProfile.none, plans = false), 1)
    .map(_.fold(missing => sys.error(missing.message), identity))
    .head
  println(s"truth ${truth.fixed(3)} m")
  for
    text  <- links
    plans <- Seq(false, true)
  do
    val link = LatencyProfile.parse(text, _ => Left("no file")).fold(no => sys.error(no.message), identity)
    val (missing, flew) = flown(settings(LoopKind.Predictive, link, plans), seeds).partitionMap(identity)
    missing.foreach(one => println(one.message))
    val off   = flew.map(_ / truth - 1).map(_ * 100)
    val stats = RunningStats.of(off.size)(off)
    println(
      s"$text, plans $plans: ${stats.mean.signed(1)} ± ${stats.halfWidth95.fixed(1)} %: " +
        off.map(_.signed(1)).mkString(", ")
    )
