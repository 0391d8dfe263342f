package skein.link

import java.nio.ByteBuffer
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.collection.mutable.ArrayBuffer
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** Prints the delays and losses of messages over lossy links, in virtual time, as `bench/netem/run.py` does
  * over Linux's netem: `link/Test/runMain skein.link.lossFigures`.
  */
@main def lossFigures(): Unit =
  def profile(text: String) = LatencyProfile.parse(text, Left(_)).fold(e => sys.error(e.message), identity)
  def quantiles(ms: Seq[Double]) =
    val sorted = ms.sorted.toVector
    Seq(.5, .8, .9, .95, .97, .98, .99, .995, .999)
      .map(p => f"${p}%s:${sorted((p * sorted.size).toInt.min(sorted.size - 1))}%.0f")
      .mkString(" ") + f" mean:${ms.sum / ms.size}%.1f max:${sorted.last}%.0f n:${ms.size}"

  /** Messages of 64 bytes on each of many connections, spread over the interval. */
  def messages(there: String, back: String, connections: Int, each: Int, everyMs: Int, udp: Boolean = false) =
    VirtualTime
      .run(1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock                     = VirtualClock(system)
        val link                      = EmulatedLink(LinkProfile(profile(there), profile(back)), 1, clock)
        val sent                      = Array.fill(connections)(Array.ofDim[Double](each))
        def now                       = clock.now().toNanos * 1e-6
        val oneWay, both              = ArrayBuffer.empty[Double]
        val known                     = ArrayBuffer.empty[Int]
        def each64(take: Int => Unit) = Flow[ByteString]
          .scan(ByteString.empty)((held, bytes) => held.drop(held.size / 64 * 64) ++ bytes)
          .drop(1)
          .map: held =>
            val whole = held.take(held.size / 64 * 64)
            whole.grouped(64).foreach(one => take(one.asByteBuffer.getInt()))
            whole
          .filter(_.nonEmpty)
        val done = (0 until connections).map: connection =>
          val server = each64: i =>
            oneWay += now - sent(connection)(i)
            known += i
          Source
            .tick((1000 + everyMs * connection / connections).millis, everyMs.millis, ())
            .zipWithIndex
            .take(each)
            .map: (_, i) =>
              sent(connection)(i.toInt) = now
              ByteString(ByteBuffer.allocate(64).putInt(0, i.toInt))
            .concat(Source.maybe[ByteString].completionTimeout(40.seconds).recoverWithRetries(
              1,
              _ => Source.empty
            ))
            .via(link.connection(TransportError.Lost(Address("b", 1), ""), udp).join(server))
            .via(each64(i => both += now - sent(connection)(i)))
            .runWith(Sink.ignore)
        Future.sequence(done).map(_ => (oneWay.toSeq, both.toSeq, known.sorted.toSeq, link.counts))
      .value

  for loss <- Seq("loss:5%", "loss:5%/4") do
    val (_, _, known, _) = messages(s"$loss,constant:100ms", "none", 1, 20_000, 2, udp = true)
    val there            = known.toSet
    val lost             = (0 until 20_000).map(!there(_))
    val runs             = lost.indices.count(i => lost(i) && (i == 0 || !lost(i - 1)))
    println(
      f"UDP $loss loss ${lost.count(identity) / 20_000.0}%.4f runs $runs burst ${lost.count(identity).toDouble / runs}%.3f"
    )
  for
    (delay, trip)                              <- Seq("50ms" -> "constant:100ms", "18ms" -> "constant:36ms")
    (label, there, back, count, each, everyMs) <- Seq(
      ("alone", "loss:5%,", "", 50, 100, 3000),
      ("alone, both ways", "loss:5%,", "loss:5%,", 50, 100, 3000),
      ("10 Hz", "loss:5%,", "", 20, 500, 100),
      ("10 Hz, bursts", "loss:5%/4,", "", 20, 500, 100),
      ("50 Hz", "loss:5%,", "", 20, 1000, 20)
    )
  do
    val (oneWay, both, _, _) = messages(there + trip, back + trip, count, each, everyMs)
    println(s"TCP $delay $label one-way ${quantiles(oneWay)}")
    if everyMs == 3000 then println(s"TCP $delay $label round trip ${quantiles(both)}")
