package skein.solver

import java.io.IOException
import skein.bytes.Codec
import skein.forecast.Estimate
import skein.loop.{Chosen, Memory, SentCommand, PlanReport, Reading, SensorReading, TeamView}
import skein.policy.{Action, Yaw}
import skein.record.PlannedPath
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** Messages as bytes: one byte for the version, then the message as [[Codec]] writes it. */
object SolverMessageCodec:
  /** Version of the encoding; other versions are refused. */
  val Version = 9

  /** Maximum size of a message, bytes: a Kafka broker's default limit, less its own overhead. */
  val MostBytes = 900_000

  val MostVehicles = 1024

  /** Encodes a message.
    *
    * @throws IllegalArgumentException if it is longer than [[MostBytes]]
    */
  def bytes(message: SolverMessage): Array[Byte] =
    val made = Version.toByte +: Codec.bytes(message)
    require(made.length <= MostBytes, s"a message has ${made.length} bytes, at most $MostBytes go")
    made

  /** Decodes a message; Left says what was expected and what was received. */
  def message(bytes: Array[Byte]): Either[String, SolverMessage] =
    if bytes.length > MostBytes then Left(s"expected $MostBytes bytes at most, got ${bytes.length}")
    else
      bytes.headOption match
        case Some(version) if version != Version =>
          Left(
            s"expected messages of version $Version of the solver's protocol, got version ${version & 0xff}"
          )
        case _ => Codec.message[SolverMessage](bytes.drop(1))

  private given [A](using Codec[A]): Codec[Stamped[A]] = Codec.derived

  private given Codec[Kinematics]    = Codec.derived
  private given Codec[Yaw]           = Codec.derived
  private given Codec[Action]        = Codec.derived
  private given Codec[Reading]       = Codec.derived
  private given Codec[SentCommand]   = Codec.derived
  private given Codec[SensorReading] = Codec.derived
  private given Codec[Estimate]      = Codec.derived
  private given Codec[TeamView]      = Codec.derived[Seen].imap(_.view)(Seen.of)

  // The policy's own memory stays at the solver.
  private given Codec[Memory] = Codec
    .derived[(Double, Option[Instant], Long, Option[Instant])]
    .imap(Memory(_, _, _, _)): memory =>
      (memory.headingRad, memory.decidedAt, memory.decisions, memory.firstReadAt)

  private given Codec[Question] = Codec
    .derived[Question]
    .imap(checked)(asked => asked.copy(view = withSensorsOf(asked.deciders.map(_.vehicle).toSet, asked.view)))

  private given Codec[PlannedPath] = Codec.derived
  private given Codec[PlanReport]  = Codec.derived
  private given Codec[Chosen]      = Codec.derived

  private given Codec[Choice]        = Codec.derived
  private given Codec[Answer]        = Codec.derived
  private given Codec[Briefing]      = Codec.derived
  private given Codec[SolverMessage] = Codec.derived

  private def checked(asked: Question): Question =
    val vehicles = asked.view.readings.size
    val whose    = asked.deciders.map(_.vehicle)
    if whose.isEmpty || whose.distinct != whose || whose.exists(!asked.view.readings.isDefinedAt(_)) then
      throw IOException(s"expected different vehicles below $vehicles, got ${whose.mkString(", ")}")
    asked

  private def withSensorsOf(vehicles: Set[Int], view: TeamView): TeamView =
    view.copy(sensed =
      view.sensed.zipWithIndex.map((sensed, its) => if vehicles(its) then sensed else Map.empty)
    )

  /** The encoded form of a view, without its forecast. */
  private final case class Seen(
      readings: Vector[Option[Reading]],
      moves: Vector[Option[SentCommand]],
      clocks: Option[(offset: Span, uncertainty: Span)],
      sensed: Vector[SensorReading],
      estimates: Option[Vector[Estimate]]
  ):
    def view: TeamView =
      val vehicles                            = readings.size
      def isOfEach(told: Vector[Option[Int]]) =
        told.size == vehicles && told.zipWithIndex.forall((whose, place) => whose.forall(_ == place))
      if vehicles > MostVehicles then
        throw IOException(s"expected $MostVehicles vehicles at most, got $vehicles")
      if !isOfEach(readings.map(_.map(_.vehicle))) || !isOfEach(moves.map(_.map(_.vehicle))) ||
        estimates.exists(_.size != vehicles) || sensed.exists(said => !readings.isDefinedAt(said.vehicle))
      then throw IOException(s"expected what is known of $vehicles vehicles, got what is of others")
      TeamView(
        readings,
        moves,
        // Bounds with this middle and half width.
        clocks.map((offset, uncertainty) =>
          ClockAlignment.of(Stamped(
            (),
            Instant.Epoch,
            Instant.Epoch + (offset - uncertainty),
            Instant.Epoch + (offset + uncertainty)
          ))
        ),
        Vector.tabulate(vehicles)(its =>
          sensed.filter(_.vehicle == its).map(said => said.sensor -> said).toMap
        ),
        None,
        estimates
      )

  private object Seen:
    def of(view: TeamView): Seen = Seen(
      view.readings,
      view.moves,
      view.alignment.map(known => (offset = known.offset, uncertainty = known.uncertainty)),
      view.sensed.flatMap(_.toVector.sortBy(_._1).map(_._2)),
      view.estimates
    )
