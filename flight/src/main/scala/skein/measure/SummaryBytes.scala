package skein.measure

import java.io.{ByteArrayInputStream, ByteArrayOutputStream, DataInputStream, DataOutputStream, IOException}
import java.util.zip.{DeflaterOutputStream, InflaterInputStream}
import scala.collection.immutable.ArraySeq
import scala.util.Using
import skein.record.{EventKind, FlightRow}
import skein.scenario.{Scenario, Track}
import skein.units.*

/** A flight's summary as bytes, and back: every number to the bit. What follows from the rest (distance, result) is
  * computed again, and the scenario is who reads' own.
  *
  * Fields in their order, big-endian; numbers of one kind by their bytes, all first bytes first, since these repeat; then
  * deflated.
  */
object SummaryBytes:
  /** Of what is inflated. */
  private val MostBytes = 256 << 20

  def write(summary: FlightSummary): ArraySeq[Byte] =
    val bytes = ByteArrayOutputStream()
    Using.resource(DataOutputStream(DeflaterOutputStream(bytes)))(Writer(_).summary(summary))
    ArraySeq.unsafeWrapArray(bytes.toByteArray)

  /** @param scenario
    *   that was flown; absent where it is not known
    * @return
    *   or why these bytes are none
    */
  def read(bytes: ArraySeq[Byte], scenario: Option[Scenario]): Either[String, FlightSummary] =
    try Right(Reader(DataInputStream(ByteArrayInputStream(inflated(bytes.toArray)))).summary(scenario))
    catch
      case wrong @ (_: IOException | _: IllegalArgumentException | _: NoSuchElementException) =>
        Left(s"expected a flight's summary, came ${bytes.length} bytes that are none: $wrong")

  private def inflated(bytes: Array[Byte]): Array[Byte] =
    val all = InflaterInputStream(ByteArrayInputStream(bytes)).readNBytes(MostBytes + 1)
    if all.length > MostBytes then throw IOException(s"they come to more than $MostBytes")
    all

  private final class Writer(out: DataOutputStream):
    def summary(of: FlightSummary): Unit =
      flight(of.flight)
      each(of.tracks)(track)
      each(of.roles)(role)
      option(of.roundTripsMs)(distribution)
      Seq(of.readings, of.decisions, of.commands).foreach(out.writeInt)
      each(of.events.toVector.sortBy(_._1.ordinal)): (kind, count) =>
        text(kind.toString)
        out.writeInt(count)
      option(of.cutShort)(text)
      option(of.policy)(text)
      option(of.planning)(planning)
      option(of.predictions): errors =>
        predictions(errors.own)
        predictions(errors.others)
      option(of.paused)(span => out.writeLong(span.toNanos))
      each(of.seeing)(seeing(_, of.scenario))
      option(of.solver)(solver)
      option(of.commandAgesMs)(distribution)

    private def flight(of: FlightRow): Unit =
      Seq(of.id, of.loop, of.link, of.clock, of.simulator, of.scenario, of.version).foreach(text)
      Seq(of.seed, of.period.toNanos, of.duration.toNanos, of.startedAt.toNanos).foreach(out.writeLong)

    private def track(of: Track): Unit =
      text(of.vehicle)
      text(of.role)
      val times = of.times.map(_.toNanos)
      longs(times.zip(0L +: times).map(_ - _))
      vectors(of.positionsNed)
      vectors(of.velocitiesNed)

    private def role(of: RoleSummary): Unit =
      text(of.role)
      each(of.observedMs.toVector.sortBy(_._1.ordinal)): (kind, observed) =>
        out.writeByte(kind.ordinal)
        distribution(observed)
      option(of.ownTrueAgeMs)(distribution)
      option(of.opponentTrueAgeMs)(distribution)

    private def planning(of: PlanningSummary): Unit =
      Seq(of.candidates, of.slices, of.tookMs).foreach(distribution)
      Seq(of.missed, of.breached).foreach(out.writeInt)

    private def predictions(of: PredictionErrors): Unit =
      out.writeInt(of.made)
      doubles(of.samples.map(_._1))
      doubles(of.samples.map(_._2))

    private def seeing(of: SeeingSummary, scenario: Option[Scenario]): Unit =
      out.writeInt(scenario.fold(-1)(_.eyes.indexOf(of.eye)))
      each(of.detections): detection =>
        out.writeLong(detection.at.toNanos)
        Seq(detection.cameraNed, detection.believedNed, detection.trueNed).foreach(vector)
        Seq(detection.orientation, detection.trueOrientation).foreach: turned =>
          Seq(turned.w, turned.x, turned.y, turned.z).foreach(out.writeDouble)
        Seq(
          detection.sinceStartS,
          detection.azimuthRad,
          detection.elevationRad,
          detection.rangeM,
          detection.tookMs
        )
          .foreach(out.writeDouble)
        option(detection.firstUsedMs)(out.writeDouble)
      out.writeInt(of.pictures)
      option(of.agesMs)(distribution)

    private def solver(of: SolverSummary): Unit =
      text(of.at)
      out.writeInt(of.answers)
      Seq(of.roundTripsMs, of.thinkingMs).foreach(option(_)(distribution))
      Seq(of.missed, of.late, of.repeated, of.left, of.lost, of.restarted).foreach(out.writeInt)

    private def text(value: String): Unit =
      val bytes = value.getBytes("UTF-8")
      out.writeInt(bytes.length)
      out.write(bytes)

    private def distribution(of: Distribution): Unit = doubles(of.sorted)

    private def vector(of: Vector3): Unit = Seq(of.x, of.y, of.z).foreach(out.writeDouble)

    private def vectors(of: Vector[Vector3]): Unit =
      doubles(of.map(_.x))
      doubles(of.map(_.y))
      doubles(of.map(_.z))

    private def doubles(of: Vector[Double]): Unit = longs(of.map(java.lang.Double.doubleToRawLongBits))

    private def longs(of: Vector[Long]): Unit =
      out.writeInt(of.size)
      for place <- 7 to 0 by -1; value <- of do out.writeByte((value >> (8 * place)).toInt)

    private def each[A](of: Seq[A])(one: A => Unit): Unit =
      out.writeInt(of.size)
      of.foreach(one)

    private def option[A](of: Option[A])(one: A => Unit): Unit =
      out.writeBoolean(of.isDefined)
      of.foreach(one)

  private final class Reader(in: DataInputStream):
    def summary(scenario: Option[Scenario]): FlightSummary =
      val flown                              = flight()
      val tracks                             = each(track())
      val roles                              = each(role())
      val trips                              = option(distribution())
      val Seq(readings, decisions, commands) = Seq.fill(3)(in.readInt())
      val events                             = each(EventKind.valueOf(text()) -> in.readInt()).toMap
      FlightSummary(
        flown,
        tracks,
        scenario,
        roles,
        trips,
        readings,
        decisions,
        commands,
        events,
        cutShort = option(text()),
        policy = option(text()),
        planning = option(planning()),
        predictions = option((own = predictions(), others = predictions())),
        paused = option(Span.ofNanos(in.readLong())),
        seeing = each(seeing(scenario)).flatten,
        solver = option(solver()),
        commandAgesMs = option(distribution())
      )

    private def flight(): FlightRow =
      val Seq(id, loop, link, clock, simulator, scenario, version) = Seq.fill(7)(text())
      val Seq(seed, period, duration, startedAt)                   = Seq.fill(4)(in.readLong())
      FlightRow(
        id,
        loop,
        link,
        seed,
        Span.ofNanos(period),
        Span.ofNanos(duration),
        clock,
        simulator,
        scenario,
        version,
        Instant.ofNanos(startedAt)
      )

    private def track(): Track =
      val (vehicle, role) = (text(), text())
      val times           = longs().scanLeft(0L)(_ + _).drop(1).map(Instant.ofNanos)
      val positions       = vectors()
      val velocities      = vectors()
      Track.of(vehicle, role, times.lazyZip(positions).lazyZip(velocities).toVector)

    private def role(): RoleSummary =
      RoleSummary(
        text(),
        each(TimingObservation.fromOrdinal(in.readByte()) -> distribution()).toMap,
        option(distribution()),
        option(distribution())
      )

    private def planning(): PlanningSummary =
      PlanningSummary(distribution(), distribution(), distribution(), in.readInt(), in.readInt())

    private def predictions(): PredictionErrors =
      PredictionErrors(in.readInt(), doubles().zip(doubles()))

    private def seeing(scenario: Option[Scenario]): Option[SeeingSummary] =
      val eye        = in.readInt()
      val detections = each:
        val at                                          = Instant.ofNanos(in.readLong())
        val Seq(camera, believed, truth)                = Seq.fill(3)(vector())
        val Seq(turned, trueTurned)                     = Seq.fill(2)(quaternion())
        val Seq(since, azimuth, elevation, range, took) = Seq.fill(5)(in.readDouble())
        Detection(
          at,
          since,
          camera,
          turned,
          azimuth,
          elevation,
          range,
          took,
          believed,
          truth,
          trueTurned,
          option(in.readDouble())
        )
      val pictures = in.readInt()
      val ages     = option(distribution())
      scenario.flatMap(_.eyes.lift(eye)).map(SeeingSummary(_, detections, pictures, ages))

    private def solver(): SolverSummary =
      SolverSummary(
        text(),
        in.readInt(),
        option(distribution()),
        option(distribution()),
        in.readInt(),
        in.readInt(),
        in.readInt(),
        in.readInt(),
        in.readInt(),
        in.readInt()
      )

    private def quaternion() = Quaternion(in.readDouble(), in.readDouble(), in.readDouble(), in.readDouble())

    private def vector() = Vector3(in.readDouble(), in.readDouble(), in.readDouble())

    private def vectors(): Vector[Vector3] =
      doubles().lazyZip(doubles()).lazyZip(doubles()).map(Vector3(_, _, _)).toVector

    private def distribution(): Distribution = Distribution.of(doubles()).get

    private def doubles(): Vector[Double] = longs().map(java.lang.Double.longBitsToDouble)

    private def longs(): Vector[Long] =
      val size   = count()
      val values = new Array[Long](size)
      for _ <- 0 until 8; index <- 0 until size do
        values(index) = values(index) << 8 | in.readUnsignedByte().toLong
      values.toVector

    private def text(): String = String(in.readNBytes(count()), "UTF-8")

    private def each[A](one: => A): Vector[A] = Vector.fill(count())(one)

    private def option[A](one: => A): Option[A] = Option.when(in.readBoolean())(one)

    /** No more than there are bytes left. */
    private def count(): Int =
      val came = in.readInt()
      if came < 0 || came > in.available then
        throw IOException(s"expected a number of at most ${in.available}, came $came")
      came
