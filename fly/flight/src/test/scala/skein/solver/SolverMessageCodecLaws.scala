package skein.solver

import org.scalacheck.Prop.forAll
import org.scalacheck.{Arbitrary, Gen}
import skein.forecast.Estimate
import skein.loop.{Chosen, Memory, SentCommand, PlanReport, Reading, SensorReading, TeamView}
import skein.policy.{Action, Yaw}
import skein.record.PlannedPath
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

class SolverMessageCodecLaws extends munit.ScalaCheckSuite:
  private val number  = Gen.oneOf(Gen.double, Gen.oneOf(-0.0, 1e300, Double.MinPositiveValue, -12.5))
  private val instant = Gen.choose(-1e18.toLong, 4e18.toLong).map(Instant.ofNanos)
  private val span    = Gen.choose(-1e12.toLong, 1e12.toLong).map(Span.ofNanos)
  private val text    = Gen.oneOf(Gen.alphaNumStr, Gen.const("höhe, 高さ\n"))
  private val vector  = Gen.zip(number, number, number).map(Vector3.apply)

  private val kinematics =
    for
      position <- vector
      velocity <- vector
      w        <- number
      axis     <- vector
      rate     <- vector
    yield Kinematics(position, velocity, Quaternion(w, axis.x, axis.y, axis.z), rate)

  private def stamped[A](value: Gen[A]) = Gen.zip(value, instant, instant, instant).map(Stamped(_, _, _, _))

  private val yaw = Gen.oneOf(
    Gen.const(Yaw.Still),
    number.map(heading => Yaw.Towards(Radians(heading))),
    number.map(Yaw.Turning(_)),
    Gen.const(Yaw.Forward)
  )

  private val action: Gen[Action] = Gen.oneOf(
    Gen.zip(vector, yaw).map(Action.Velocity(_, _)),
    Gen.zip(number, number, number, yaw).map((north, east, down, yaw) =>
      Action.VelocityAt(north, east, Metres(down), yaw)
    ),
    Gen.zip(vector, number, yaw).map((to, speed, yaw) => Action.Position(to, MetresPerSecond(speed), yaw)),
    yaw.map(Action.Turn(_)),
    Gen.zip(number, number, number, number).map((roll, pitch, yaw, thrust) =>
      Action.Attitude(Radians(roll), Radians(pitch), Radians(yaw), thrust)
    ),
    Gen.const(Action.Hover),
    Gen.const(Action.Land)
  )

  private def move(vehicle: Int) =
    Gen.zip(Gen.long, number, instant, action).map((decision, heading, at, action) =>
      SentCommand(vehicle, decision, Radians(heading), at, action)
    )

  /** Clock alignments with a whole middle and half width. */
  private val alignment = Gen.zip(span, Gen.choose(0L, 1_000_000L)).map: (offset, half) =>
    val width = Span.ofNanos(half)
    ClockAlignment.of(Stamped(
      (),
      Instant.Epoch,
      Instant.Epoch + (offset - width),
      Instant.Epoch + (offset + width)
    ))

  private def view(vehicles: Int, self: Int) =
    for
      readings <- Gen.sequence[Vector[Option[Reading]], Option[Reading]](
        (0 until vehicles).map(vehicle =>
          Gen.option(Gen.zip(Gen.long, stamped(kinematics)).map(Reading(vehicle, _, _)))
        )
      )
      moves <- Gen.sequence[Vector[Option[SentCommand]], Option[SentCommand]](
        (0 until vehicles).map(vehicle => Gen.option(move(vehicle)))
      )
      alignment <- Gen.option(alignment)
      sensed    <- Gen.option(Gen.zip(Gen.long, stamped(Gen.listOfN(3, number).map(_.toVector))))
      estimates <- Gen.option(
        Gen.listOfN(
          vehicles,
          Gen.zip(kinematics, instant, instant, Gen.listOf(number).map(_.toVector)).map(Estimate(_, _, _, _))
        ).map(_.toVector)
      )
    yield
      val said = sensed.map((number, values) =>
        "gps" -> SensorReading(self, "gps", number, Vector("a", "b", "c"), values)
      )
      val empty = TeamView.empty(vehicles)
      TeamView(readings, moves, alignment, empty.sensed.updated(self, said.toMap), None, estimates)

  private val pair = Gen.zip(Gen.long, Gen.long)

  private val question =
    for
      vehicles  <- Gen.choose(1, 5)
      count     <- Gen.choose(1, vehicles)
      deciders  <- Gen.pick(count, 0 until vehicles)
      known     <- Gen.option(Gen.zip(Gen.long, span))
      used      <- Gen.option(pair)
      heading   <- number
      decidedAt <- Gen.option(instant)
      made      <- Gen.long
      seen      <- view(vehicles, deciders.head)
      at        <- instant
      flight    <- Gen.long
    yield Question(
      flight,
      deciders.toVector.map(vehicle => (vehicle = vehicle, memory = Memory(heading, decidedAt, made))),
      made / 2,
      at,
      known.map((solver, offset) => (solver = solver, offset = offset)),
      used.map((solver, question) => (solver = solver, question = question)),
      seen
    )

  private val course =
    Gen.zip(Gen.listOf(number), Gen.listOf(number), span).map((north, east, step) =>
      PlannedPath(north.toVector, east.toVector, step)
    )

  private val plan =
    for
      candidates <- Gen.long
      slices     <- Gen.listOf(Gen.choose(0, Int.MaxValue))
      cost       <- Gen.option(number)
      searched   <- Gen.oneOf(true, false)
      breaches   <- Gen.choose(0, 99)
      breach     <- Gen.option(text)
      course     <- Gen.option(course)
    yield PlanReport(candidates, slices.toVector, cost, searched, !searched, breaches, breach, course)

  private val chosen =
    Gen.zip(action, Gen.option(plan)).map(Chosen(_, _))

  private val choice =
    Gen.zip(instant, Gen.oneOf(true, false), Gen.listOf(chosen)).map((at, isNew, chosen) =>
      Choice(at, isNew, chosen.toVector)
    )

  private val answer =
    for
      (flight, number)  <- pair
      (solver, left)    <- pair
      vehicle           <- Gen.choose(0, 1023)
      (taken, answered) <- Gen.zip(instant, instant)
      result            <- Gen.either(text, choice)
    yield Answer(flight, vehicle, number, solver, taken, answered, left, left / 3, result)

  private val briefing =
    Gen.zip(text, text, Gen.long, span, span, Gen.listOf(Gen.zip(text, text)), Gen.listOf(text)).map:
      (scenario, loop, seed, period, duration, parameters, agents) =>
        Briefing(scenario, loop, seed, period, duration, parameters.toVector, agents.toVector)

  private val message: Gen[SolverMessage] = Gen.oneOf(
    Gen.zip(Gen.long, text, briefing).map(SolverMessage.Hello(_, _, _)),
    Gen.zip(Gen.long, Gen.long).map(SolverMessage.Welcome(_, _)),
    Gen.zip(Gen.long, text).map(SolverMessage.Refused(_, _)),
    Gen.long.map(SolverMessage.Unknown(_)),
    Gen.long.map(SolverMessage.Preparing(_)),
    question.map(SolverMessage.Ask(_)),
    answer.map(SolverMessage.Tell(_)),
    Gen.long.map(SolverMessage.Goodbye(_))
  )

  property("a message is read back as it was written, to the last bit"):
    forAll(message): message =>
      val bytes = SolverMessageCodec.bytes(message)
      val read  = SolverMessageCodec.message(bytes).fold(fail(_), identity)
      assertEquals(read, message)
      assertEquals(SolverMessageCodec.bytes(read).toVector, bytes.toVector)

  property("a truncated message, or one with extra bytes, is refused"):
    forAll(message, Gen.double): (message, share) =>
      val bytes = SolverMessageCodec.bytes(message)
      assert(SolverMessageCodec.message(bytes.take((bytes.length * share).toInt)).isLeft)
      assert(SolverMessageCodec.message(bytes :+ 0.toByte).left.exists(_.contains("1 more byte")))

  property("any bytes are read or refused, and no length in them is trusted"):
    forAll(message, Gen.listOf(Gen.zip(Gen.double, Arbitrary.arbitrary[Byte]))): (message, changes) =>
      val bytes = SolverMessageCodec.bytes(message)
      for (share, value) <- changes do bytes((bytes.length * share).toInt.min(bytes.length - 1)) = value
      val _ = SolverMessageCodec.message(bytes)

  property("garbage is refused"):
    forAll(Arbitrary.arbitrary[Array[Byte]])(bytes =>
      SolverMessageCodec.message(bytes).isLeft || bytes.length > 9
    )

  test("an error message states what was expected and what was received"):
    val welcome = SolverMessageCodec.bytes(SolverMessage.Welcome(1, 2))
    assertEquals(
      SolverMessageCodec.message(welcome.updated(0, 10.toByte)),
      Left("expected messages of version 9 of the solver's protocol, got version 10")
    )
    assertEquals(
      SolverMessageCodec.message(welcome.updated(1, 42.toByte)),
      Left("expected a kind of solver message from 1 to 8, got 42")
    )
    assertEquals(
      SolverMessageCodec.message(new Array[Byte](SolverMessageCodec.MostBytes + 1)),
      Left(
        s"expected ${SolverMessageCodec.MostBytes} bytes at most, got ${SolverMessageCodec.MostBytes + 1}"
      )
    )
    val memory   = Memory(0, None, 0)
    val question = Question(1, Vector.empty, 0, Instant.Epoch, None, None, TeamView.empty(2))
    for deciders <- Seq(Vector(), Vector(2), Vector(-1), Vector(1, 1)) do
      val asked = question.copy(deciders = deciders.map(vehicle => (vehicle = vehicle, memory = memory)))
      assertEquals(
        SolverMessageCodec.message(SolverMessageCodec.bytes(SolverMessage.Ask(asked))),
        Left(s"expected different vehicles below 2, got ${deciders.mkString(", ")}")
      )
    val claims = SolverMessageCodec.bytes(SolverMessage.Refused(1, "no")).updated(10, 0x7f.toByte)
    assert(SolverMessageCodec.message(claims).left.exists(_.startsWith("expected a length of 0 to ")))
