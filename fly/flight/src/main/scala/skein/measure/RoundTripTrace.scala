package skein.measure

import skein.airsim.VehicleErrors
import skein.loop.{Reading, TeamLog}
import skein.record.{EventKind, EventSubject, Recording}
import skein.units.Expect

/** Requests over a link, in the order of sending.
  *
  * @param sentAtS time of sending of each request, since any moment
  * @param roundTripsMs None for a request without an answer
  */
final case class RoundTripTrace(sentAtS: Vector[Double], roundTripsMs: Vector[Option[Double]]):
  def size: Int                = sentAtS.size
  def answered: Vector[Double] = roundTripsMs.flatten
  def lost: Vector[Boolean]    = roundTripsMs.map(_.isEmpty)

object RoundTripTrace:
  private val MostMs = 3_600_000.0

  /** The readings of a recording, by controller and vehicle. A reading that was not answered in time is
    * missing, and counts as lost. One that was refused, or answered without data of the sensors, is left out:
    * the link carried it.
    */
  def of(recording: Recording): Vector[RoundTripTrace] =
    val controllers = Reading.controllers(recording.heading)
    val without     = recording.events
      .filter: event =>
        event.about.contains(EventSubject.Reading) &&
          (event.kind == EventKind.Refused || event.detail.endsWith(VehicleErrors.noReading.message))
      .flatMap(event => event.vehicle.zip(TeamLog.unreadNumber(event.detail)))
      .toSet
    Reading.asked(recording).groupBy(read => (read.vehicle, read.sequence % controllers)).values.toVector.map:
      readings =>
        val known   = readings.map(reading => reading.sequence -> reading.state).toMap
        val first   = known.keys.min
        val last    = known.keys.max
        val from    = known(first).sentAt.toSeconds
        val everyS  = (known(last).sentAt.toSeconds - from) / (last - first).max(1)
        val numbers =
          (first to last by controllers).filterNot(number =>
            without((readings.head.vehicle, number))
          ).toVector
        RoundTripTrace(
          numbers.map(number => known.get(number).fold(from + (number - first) * everyS)(_.sentAt.toSeconds)),
          numbers.map(known.get(_).map(state => state.receivedAt.since(state.sentAt).toMillis))
        )

  /** Reads the output of `ping`, or lines `time_s,rtt_ms`; a request without an answer has nothing after the
    * comma.
    *
    * @return Left says what was expected and received, and in which line
    */
  def parse(text: String): Either[String, RoundTripTrace] =
    val lines = text.linesIterator.map(_.trim).zipWithIndex.map((line, i) => (line, i + 1)).toVector
    if lines.exists((line, _) => line.contains("icmp_seq=")) then ofPing(lines) else ofTable(lines)

  private val answer  = """.*icmp_seq=(\d+) .*time[=<]([\d.]+) ?ms.*""".r
  private val summary = """(\d+) packets transmitted, .* time (\d+)ms.*""".r

  private def ofPing(lines: Vector[(String, Int)]): Either[String, RoundTripTrace] =
    for
      read <- Expect.each(lines.collect { case (answer(number, ms), line) => (number, ms, line) }):
        (number, ms, line) =>
          number.toIntOption.zip(ms.toDoubleOption.filter(_ <= MostMs)).toRight(
            s"line $line: expected a number and milliseconds, got 'icmp_seq=$number' and 'time=$ms'"
          )
      totals <- Expect.each(lines.collectFirst { case (summary(sent, lastsMs), line) =>
        (sent, lastsMs, line)
      }): (sent, lastsMs, line) =>
        sent.toIntOption.zip(lastsMs.toLongOption.map(_.toDouble)).toRight(
          s"line $line: expected the number of packets and milliseconds, got '$sent' and '$lastsMs'"
        )
      total = totals.headOption
      trips = unwrapped(read).reverse.toMap
      _ <- Expect.that(trips.nonEmpty)(
        "expected the answers of ping, such as 'icmp_seq=1 ttl=64 time=36.1 ms', got none"
      )
      first = trips.keys.min.min(1)
      last  = trips.keys.max.max(total.fold(0)(first + _._1 - 1))
      _ <- Expect.that(
        last - first < MostSamples
      )(s"expected at most $MostSamples requests, got ${last - first + 1}")
      // Without a summary, ping was stopped by force: it sends once a second by default.
      everyS = total.filter(_._1 > 1).fold(1.0)((sent, lastsMs) => lastsMs / 1000 / (sent - 1))
    yield RoundTripTrace(
      Vector.tabulate(last - first + 1)(_ * everyS),
      Vector.tabulate(last - first + 1)(i => trips.get(first + i))
    )

  /** Numbers of requests beyond 16 bits, with which `ping` begins anew: each as near as possible to the one
    * before.
    */
  private def unwrapped(read: Vector[(Int, Double)]): Vector[(Int, Double)] =
    val numbers = read.map(_._1).scanLeft(read.headOption.fold(0)(_._1)): (before, number) =>
      number + math.round((before - number).toDouble / Numbers).toInt * Numbers
    numbers.drop(1).zip(read.map(_._2))

  private val Numbers = 1 << 16

  private def ofTable(lines: Vector[(String, Int)]): Either[String, RoundTripTrace] =
    val rows = lines.filterNot((line, _) => line.isEmpty || line.startsWith("#") || line == "time_s,rtt_ms")
    for
      _ <- Expect.that(rows.size <= MostSamples)(s"expected at most $MostSamples requests, got ${rows.size}")
      read <- Expect.each(rows): (line, number) =>
        val row = line.split(",", -1) match
          case Array(time, "") => time.toDoubleOption.map((_, None))
          case Array(time, ms) =>
            time.toDoubleOption.zip(ms.toDoubleOption.filter(t => t >= 0 && t <= MostMs).map(Some(_)))
          case _ => None
        row.filter(_._1.isFinite).toRight(
          s"line $number: expected time_s,rtt_ms, such as 0.1,36.2, or 0.1, where no answer came; got '$line'"
        )
      _ <- Expect.that(read.exists(_._2.nonEmpty))("expected round trips, got none")
      _ <- Expect.that(read.map(_._1).sliding(2).forall(pair => pair.head <= pair.last)):
        "expected times in ascending order"
    yield RoundTripTrace(read.map(_._1), read.map(_._2))

  private val MostSamples = 1_000_000
