package skein.flight

import skein.loop.*
import skein.settings.*
import skein.signal.*
import skein.units.*

/** The duel over AirSim's wire protocol and over MAVLink, in virtual time: mean distance in the second half,
  * and the deviation of recorded ages from the simulator's ground truth. Lists are separated by commas.
  */
@main def mavlinkFigures(wires: String, links: String, loops: String, seconds: Int, seeds: Int): Unit =
  for
    link <- links.split(',')
    loop <- loops.split(',')
    wire <- wires.split(',')
  do
    val results = (1 to seeds).map: seed =>
      val settings = FlySettings(
        List(LoopKind.parse(loop).toOption.get),
        List(LatencyProfile.parse(link, _ => Left("")).toOption.get),
        Span.ofSeconds(seconds),
        Span.ofMillis(100),
        seed,
        wire = Wire.parse(wire).toOption.get
      )
      val started = System.nanoTime()
      VirtualFlights.fly(settings, settings.plans.head.copy(seed = seed)) match
        case Left(why)     => println(s"$wire $link $loop $seed: $why"); Double.NaN
        case Right(landed) =>
          val decisions = landed.recorder.recording.decisions
          val late      =
            decisions.filter(d => d.decidedAt.since(decisions.head.decidedAt).toSeconds > seconds / 2.0)
          val distances = late.map(d =>
            d.own.state.value.positionNed.horizontalDistance(d.opponent.state.value.positionNed)
          )
          val age  = decisions.flatMap(_.trueAge).map(_.own.toMillis)
          val boot =
            if wire == "mavlink" then landed.recorder.recording.heading.flight.startedAt else Instant.Epoch
          val errors = decisions.flatMap: d =>
            d.trueAge.map: t =>
              val error = t.own - d.decidedAt.since(boot + d.own.state.validAt.since(Instant.Epoch))
              (atS = d.decidedAt.since(decisions.head.decidedAt).toSeconds, ms = error.toMillis.abs)
          def told(fromS: Double, untilS: Double): String =
            val some = errors.collect { case (atS, ms) if atS >= fromS && atS < untilS => ms }.sorted
            def at(share: Double) = some((some.size * share).toInt.min(some.size - 1))
            f"${at(0.5)}%.2f, ${at(0.99)}%.2f, ${some.last}%.2f"
          println(
            s"  age errors, ms, median, 99 %, most: ${told(0, seconds)}; in the " +
              s"first 10 s ${told(0, 10)}, afterwards ${told(10, seconds)}"
          )
          println(
            f"$wire $link $loop $seed: ${landed.landed.outcome} decisions " +
              f"${decisions.size} distance ${distances.sum / distances.size}%.3f age " +
              f"${age.sum / age.size}%.2f ms, ${(System.nanoTime() - started) / 1e9}%.1f s"
          )
          distances.sum / distances.size
    println(f"MEAN $wire $link $loop ${results.sum / results.size}%.3f")
