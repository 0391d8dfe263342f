package skein.solver

import java.io.{
  ByteArrayInputStream,
  ByteArrayOutputStream,
  DataInputStream,
  DataOutputStream,
  EOFException,
  IOException
}
import skein.forecast.Estimate
import skein.loop.{Memory, Move, Reading, SensorReading, TeamView}
import skein.policy.{Action, Yaw}
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** Messages as bytes: a byte for the version, a byte for the kind, then the fields in their order, big-endian; numbers by
  * all their bits, times in nanoseconds, texts behind their length in bytes, lists behind their length, what may be absent
  * behind a byte that says whether it is there. No size that a peer states is believed before it is seen to be within its
  * bound.
  */
object MessageCodec:
  /** Peers of another version are refused. */
  val Version = 1

  /** Of a message, in bytes: what a Kafka broker takes unless told otherwise, less its own share. */
  val MostBytes = 900_000

  val MostVehicles = 1024

  private val MostText    = 800_000
  private val MostLines   = 65_536
  private val MostSensors = 64
  private val MostNumbers = 65_536

  /** @throws IllegalArgumentException
    *   if it is longer than [[MostBytes]]
    */
  def bytes(message: Message): Array[Byte] =
    val into = ByteArrayOutputStream(1024)
    val out  = Writer(DataOutputStream(into))
    out.message(message)
    val made = into.toByteArray
    require(made.length <= MostBytes, s"a message has ${made.length} bytes, at most $MostBytes go")
    made

  /** @return or what was expected, and what came */
  def message(bytes: Array[Byte]): Either[String, Message] =
    try
      if bytes.length > MostBytes then
        throw IOException(s"expected $MostBytes bytes at most, came ${bytes.length}")
      val in   = DataInputStream(ByteArrayInputStream(bytes))
      val read = Reader(in).message()
      Either.cond(in.available == 0, read, s"expected the message's end, came ${in.available} more bytes")
    catch
      case _: EOFException    => Left(s"the message is cut off after ${bytes.length} bytes")
      case wrong: IOException => Left(wrong.getMessage)

  private final class Writer(out: DataOutputStream):
    def message(message: Message): Unit =
      out.writeByte(Version)
      message match
        case Message.Hello(flight, build, briefing) =>
          start(1, flight)
          text(build)
          this.briefing(briefing)
        case Message.Welcome(flight, solver) =>
          start(2, flight)
          out.writeLong(solver)
        case Message.Refused(flight, reason) =>
          start(3, flight)
          text(reason)
        case Message.Unknown(flight) => start(4, flight)
        case Message.Ask(question)   =>
          start(5, question.flight)
          this.question(question)
        case Message.Tell(answer) =>
          start(6, answer.flight)
          this.answer(answer)
        case Message.Goodbye(flight) => start(7, flight)

    private def start(kind: Int, flight: Long): Unit =
      out.writeByte(kind)
      out.writeLong(flight)

    private def briefing(one: Briefing): Unit =
      text(one.scenario)
      text(one.loop)
      out.writeLong(one.seed)
      span(one.period)
      span(one.duration)
      list(one.parameters): (name, value) =>
        text(name)
        text(value)
      list(one.agents)(text)

    private def question(asked: Question): Unit =
      out.writeShort(asked.vehicle)
      out.writeLong(asked.number)
      instant(asked.askedAt)
      option(asked.solverClock): known =>
        out.writeLong(known.solver)
        span(known.offset)
      option(asked.remembered): used =>
        out.writeLong(used.solver)
        out.writeLong(used.question)
      out.writeDouble(asked.memory.headingRad)
      option(asked.memory.decidedAt)(instant)
      out.writeLong(asked.memory.decisions)
      view(asked.vehicle, asked.view)

    private def view(vehicle: Int, view: TeamView): Unit =
      out.writeShort(view.readings.size)
      for reading <- view.readings do
        option(reading): reading =>
          out.writeLong(reading.sequence)
          stamped(reading.state)(kinematics)
      for move <- view.moves do
        option(move): move =>
          out.writeLong(move.decision)
          out.writeDouble(move.headingRad)
          instant(move.sentAt)
          option(move.speed)(speed => out.writeDouble(speed.value))
          option(move.action)(action)
      option(view.alignment): known =>
        span(known.offset)
        span(known.uncertainty)
      list(view.sensed(vehicle).toVector.sortBy(_._1)): (name, said) =>
        text(name)
        out.writeLong(said.sequence)
        list(said.columns)(text)
        stamped(said.values)(list(_)(out.writeDouble))
      option(view.estimates)(_.foreach: estimate =>
        kinematics(estimate.kinematics)
        instant(estimate.predictedFor)
        instant(estimate.readAt))

    private def answer(told: Answer): Unit =
      out.writeShort(told.vehicle)
      out.writeLong(told.number)
      out.writeLong(told.solver)
      instant(told.takenAt)
      instant(told.answeredAt)
      out.writeLong(told.overtaken)
      out.writeLong(told.repeated)
      told.result match
        case Left(reason) =>
          out.writeBoolean(false)
          text(reason)
        case Right(choice) =>
          out.writeBoolean(true)
          instant(choice.decidedAt)
          out.writeBoolean(choice.begunAnew)
          out.writeDouble(choice.headingRad)
          option(choice.speed)(speed => out.writeDouble(speed.value))
          option(choice.action)(action)

    private def action(action: Action): Unit = action match
      case Action.Velocity(velocity, yaw) =>
        out.writeByte(1)
        vector(velocity)
        this.yaw(yaw)
      case Action.VelocityAt(north, east, down, yaw) =>
        out.writeByte(2)
        out.writeDouble(north)
        out.writeDouble(east)
        out.writeDouble(down.value)
        this.yaw(yaw)
      case Action.Position(position, speed, yaw) =>
        out.writeByte(3)
        vector(position)
        out.writeDouble(speed.value)
        this.yaw(yaw)
      case Action.Turn(yaw) =>
        out.writeByte(4)
        this.yaw(yaw)
      case Action.Attitude(roll, pitch, yaw, thrust) =>
        out.writeByte(5)
        for number <- Seq(roll.value, pitch.value, yaw.value, thrust) do out.writeDouble(number)
      case Action.Hover => out.writeByte(6)
      case Action.Land  => out.writeByte(7)

    private def yaw(yaw: Yaw): Unit = yaw match
      case Yaw.Still            => out.writeByte(1)
      case Yaw.Towards(heading) =>
        out.writeByte(2)
        out.writeDouble(heading.value)
      case Yaw.Turning(rate) =>
        out.writeByte(3)
        out.writeDouble(rate)
      case Yaw.Forward => out.writeByte(4)

    private def stamped[A](said: Stamped[A])(write: A => Unit): Unit =
      write(said.value)
      instant(said.validAt)
      instant(said.sentAt)
      instant(said.receivedAt)

    private def kinematics(of: Kinematics): Unit =
      vector(of.positionNed)
      vector(of.velocityNed)
      for number <- Seq(of.orientation.w, of.orientation.x, of.orientation.y, of.orientation.z) do
        out.writeDouble(number)
      vector(of.angularVelocityFrd)

    private def vector(of: Vector3): Unit = for number <- Seq(of.x, of.y, of.z) do out.writeDouble(number)

    private def instant(at: Instant): Unit = out.writeLong(at.toNanos)
    private def span(of: Span): Unit       = out.writeLong(of.toNanos)

    private def text(of: String): Unit =
      val encoded = of.getBytes("UTF-8")
      out.writeInt(encoded.length)
      out.write(encoded)

    private def list[A](all: Seq[A])(write: A => Unit): Unit =
      out.writeInt(all.size)
      all.foreach(write)

    private def option[A](maybe: Option[A])(write: A => Unit): Unit =
      out.writeBoolean(maybe.isDefined)
      maybe.foreach(write)

  private final class Reader(in: DataInputStream):
    def message(): Message =
      val version = in.readUnsignedByte()
      if version != Version then
        throw IOException(
          s"expected messages of version $Version of the solver's protocol, came version $version"
        )
      val kind   = in.readUnsignedByte()
      val flight = in.readLong()
      kind match
        case 1     => Message.Hello(flight, text(), briefing())
        case 2     => Message.Welcome(flight, in.readLong())
        case 3     => Message.Refused(flight, text())
        case 4     => Message.Unknown(flight)
        case 5     => Message.Ask(question(flight))
        case 6     => Message.Tell(answer(flight))
        case 7     => Message.Goodbye(flight)
        case other => throw IOException(s"expected a kind of message from 1 to 7, came $other")

    private def briefing(): Briefing =
      Briefing(
        text(),
        text(),
        in.readLong(),
        span(),
        span(),
        list(MostLines)((text(), text())),
        list(MostLines)(text())
      )

    private def question(flight: Long): Question =
      val vehicle = in.readUnsignedShort()
      val asked   = Question(
        flight,
        vehicle,
        in.readLong(),
        instant(),
        option((solver = in.readLong(), offset = span())),
        option((solver = in.readLong(), question = in.readLong())),
        Memory(in.readDouble(), option(instant()), in.readLong()),
        view(vehicle)
      )
      asked

    private def view(vehicle: Int): TeamView =
      val vehicles = in.readUnsignedShort()
      if vehicles > MostVehicles then
        throw IOException(s"expected $MostVehicles vehicles at most, came $vehicles")
      if vehicle >= vehicles then throw IOException(s"expected a vehicle below $vehicles, came $vehicle")
      val empty    = TeamView.empty(vehicles)
      val readings = Vector.tabulate(vehicles): index =>
        option(Reading(index, in.readLong(), stamped(kinematics())))
      val moves = Vector.tabulate(vehicles): index =>
        option:
          val decision = in.readLong()
          Move(
            index,
            decision,
            in.readDouble(),
            instant(),
            option(MetresPerSecond(in.readDouble())),
            option(action())
          )
      val alignment = option:
        val (offset, uncertainty) = (span(), span())
        // Bounds whose middle and half width these are.
        ClockAlignment.of(
          Stamped(
            (),
            Instant.Epoch,
            Instant.Epoch + (offset - uncertainty),
            Instant.Epoch + (offset + uncertainty)
          )
        )
      val sensed = list(MostSensors):
        val name = text()
        name -> SensorReading(
          vehicle,
          name,
          in.readLong(),
          list(MostNumbers)(text()),
          stamped(list(MostNumbers)(in.readDouble()))
        )
      val estimates = option(Vector.fill(vehicles)(Estimate(kinematics(), instant(), instant())))
      TeamView(readings, moves, alignment, empty.sensed.updated(vehicle, sensed.toMap), None, estimates)

    private def answer(flight: Long): Answer =
      Answer(
        flight,
        in.readUnsignedShort(),
        in.readLong(),
        in.readLong(),
        instant(),
        instant(),
        in.readLong(),
        in.readLong(),
        if in.readBoolean() then
          Right(Choice(
            instant(),
            in.readBoolean(),
            in.readDouble(),
            option(MetresPerSecond(in.readDouble())),
            option(action())
          ))
        else Left(text())
      )

    private def action(): Action = in.readUnsignedByte() match
      case 1     => Action.Velocity(vector(), yaw())
      case 2     => Action.VelocityAt(in.readDouble(), in.readDouble(), Metres(in.readDouble()), yaw())
      case 3     => Action.Position(vector(), MetresPerSecond(in.readDouble()), yaw())
      case 4     => Action.Turn(yaw())
      case 5     => Action.Attitude(radians(), radians(), radians(), in.readDouble())
      case 6     => Action.Hover
      case 7     => Action.Land
      case other => throw IOException(s"expected a kind of action from 1 to 7, came $other")

    private def yaw(): Yaw = in.readUnsignedByte() match
      case 1     => Yaw.Still
      case 2     => Yaw.Towards(radians())
      case 3     => Yaw.Turning(in.readDouble())
      case 4     => Yaw.Forward
      case other => throw IOException(s"expected a kind of yaw from 1 to 4, came $other")

    private def radians() = Radians(in.readDouble())

    private def stamped[A](value: => A): Stamped[A] = Stamped(value, instant(), instant(), instant())

    private def kinematics(): Kinematics =
      Kinematics(
        vector(),
        vector(),
        Quaternion(in.readDouble(), in.readDouble(), in.readDouble(), in.readDouble()),
        vector()
      )

    private def vector() = Vector3(in.readDouble(), in.readDouble(), in.readDouble())

    private def instant() = Instant.ofNanos(in.readLong())
    private def span()    = Span.ofNanos(in.readLong())

    private def count(most: Int): Int =
      val came = in.readInt()
      if came < 0 || came > most then throw IOException(s"expected a length of 0 to $most, came $came")
      came

    private def text(): String =
      val length = count(MostText)
      if length > in.available then throw IOException(s"expected $length more bytes, came ${in.available}")
      String(in.readNBytes(length), "UTF-8")

    private def list[A](most: Int)(read: => A): Vector[A] = Vector.fill(count(most))(read)

    private def option[A](read: => A): Option[A] = Option.when(in.readBoolean())(read)
