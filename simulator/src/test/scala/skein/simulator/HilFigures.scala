package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.hil.{AutopilotKind, SmallAutopilot}
import skein.link.{Address, ControlThreads, PreciseScheduler, TcpTransport}
import skein.units.{Clock, Span}

/** What PX4's interface does in lockstep: `lockstep SECONDS` in virtual time, how many times as fast as the clock, twice
  * with equal digests; `clock SECONDS` over TCP by the clock, the gaps between sensors as the autopilot sees them.
  */
@main def hilFigures(what: String, seconds: Int): Unit = what match
  case "lockstep" =>
    val flights = Vector.fill(3)(HilFlightSimulation.fly(1, Span.ofSeconds(seconds), speed = 1))
    for flight <- flights do
      println(
        s"$seconds s simulated in ${round(flight.seconds)} s: ${round(seconds / flight.seconds)} times real time; " +
          s"${flight.sensors} HIL_SENSOR; at ${flight.positionNed}; ${flight.digest}"
      )
    println(if flights.map(_.digest).distinct.size == 1 then "digests are equal" else "DIGESTS DIFFER")
  case "clock" =>
    given system: ActorSystem = ActorSystem("hil", PreciseScheduler.config)
    try
      val settings = SimulatorSettings(
        address = Address("127.0.0.1", 0),
        hil = Some(HilSettings(AutopilotKind.Px4, Vector(Address("127.0.0.1", 0))))
      )
      val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
      // Until the compilers have seen it.
      Await.ready(
        HilPeer.fly(SmallAutopilot(), 20_000_000, server.peerAddresses.head, TcpTransport())(),
        1.minute
      )
      println(s"${ControlThreads.lead()} threads go first")
      val arrivals = HilPeer.Arrivals()
      val flown    = HilPeer.fly(
        SmallAutopilot(),
        (seconds + 20) * 1_000_000L,
        server.peerAddresses.head,
        TcpTransport()
      )(arrivals.note)
      Await.ready(flown, (seconds + 60).seconds)
      val gaps = arrivals.at.sliding(2).map(pair => (pair(1).nanos - pair(0).nanos) * 1e-6).toVector.sorted
      def at(share: Double) = round(gaps(((gaps.size - 1) * share).toInt))
      val rate              = arrivals.at.size / ((arrivals.at.last.nanos - arrivals.at.head.nanos) * 1e-9)
      println(
        s"${arrivals.at.size} HIL_SENSOR at ${round(rate)} Hz; gaps in ms: p50 ${at(0.5)}, p99 ${at(0.99)}, p99.9 ${at(0.999)}, " +
          s"greatest ${at(1)}; above 8 ms: ${gaps.count(_ > 8)}; ${server.peerStats}"
      )
      Await.result(server.close(), 10.seconds): Unit
    finally
      val _ = Await.result(system.terminate(), 20.seconds)
  case other => println(s"expected lockstep or clock, came '$other'")

private def round(value: Double): Double = math.round(value * 100) / 100.0
