package skein.record

import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** Records with a different value in every field. */
object Samples:

  val heading: RecordingHeader = RecordingHeader(
    FlightRow(
      id = "stream-vpn",
      loop = "stream",
      link = "vpn",
      seed = -7,
      period = Span.ofMillis(100),
      duration = Span.ofSeconds(60),
      clock = "virtual",
      simulator = Simulator.BuiltIn,
      scenario = "duel",
      version = "0.1.0",
      startedAt = Instant.ofNanos(1_790_000_000_123_456_789L),
      scenarioName = Some("duel")
    ),
    Seq(
      VehicleRow("Pursuer", "pursuer", MetresPerSecond(10), Vector3(0, 0, 0)),
      VehicleRow("Evader", "evader", MetresPerSecond(5), Vector3(21, 0.5, -0.25))
    ),
    Seq(ParameterRow("turningRadiusM", "8"))
  )

  def at(nanos: Long): Instant = heading.flight.startedAt + Span.ofNanos(nanos)

  def reading(sequence: Long, vehicle: String = "Pursuer"): ReadingRow =
    val base = sequence * 100_000_000L
    ReadingRow(
      sequence,
      vehicle,
      Stamped(
        Kinematics(
          Vector3(sequence + 0.1, sequence + 0.2, -20.3),
          Vector3(1.1, -2.2, math.Pi),
          Quaternion(0.5, -0.5, 0.25, -0.75),
          Vector3(0.01, 0.02, -0.03)
        ),
        validAt = Instant.ofNanos(base + 3_000_001),
        sentAt = at(base),
        receivedAt = at(base + 36_800_000)
      )
    )

  def decision(sequence: Long): DecisionRow = DecisionRow(
    sequence,
    vehicle = "Pursuer",
    decidedAt = at(sequence * 100_000_000L + 40_000_001),
    own = reading(sequence),
    opponent = reading(sequence + 1, "Evader"),
    relativeX = Metres(12.5),
    relativeY = Metres(-3.25),
    headingBefore = Radians(0.8776),
    opponentHeading = Radians(-1.5),
    heading = Radians(0.9776),
    elapsed = Span.ofNanos(100_000_001),
    observations =
      Observations(Span.ofNanos(1_234_567), Span.ofNanos(26_000_003), Some(Span.ofNanos(79_999_999)), None),
    trueAge = Some(
      TrueAge(
        Span.ofMillis(20.5),
        Span.ofMillis(45.25),
        Span.ofNanos(1_790_000_000_000_000_001L),
        Span.ofMillis(2.5)
      )
    ),
    predicted = Some(
      Predicted(
        Instant.ofNanos(4_000_001),
        Vector3(1.5, 2.5, -20.5),
        Vector3(9.5, -0.5, 0.25),
        Vector3(21.5, 1.25, -19.75),
        Vector3(4.5, 0.75, -0.125)
      )
    )
  )

  /** Of 40 × 30 pixels, no two rows alike. */
  def image(sequence: Long): CameraImage =
    val base = sequence * 33_000_000L
    CameraImage(
      sequence,
      "Pursuer",
      "front_center",
      "Scene",
      "bgr8",
      40,
      30,
      Some(Radians(1.5)),
      Vector3(0.5, 1.25, -20.5),
      Quaternion(0.5, 0.5, -0.5, 0.5),
      Instant.ofNanos(base + 3_000_002),
      at(base),
      at(base + 26_000_000),
      Blob.of(Array.tabulate(40 * 30 * 3)(index => (index * 7 + sequence).toByte))
    )

  def cloud(sequence: Long): Cloud =
    Cloud(
      sequence,
      "Evader",
      "Lidar",
      3,
      Vector3(20.5, 1.25, -20.5),
      Quaternion(1, 0, 0, 0),
      Instant.ofNanos(sequence * 100_000_000L),
      at(sequence * 100_000_000L),
      at(sequence * 100_000_000L + 12_000_000),
      Blob.of(Array.tabulate(36)(index => (index * 5).toByte))
    )

  val oneOfEach: Vector[Record] = Vector(
    reading(1),
    decision(1),
    decision(2).copy(trueAge = None, predicted = None, speed = Some(MetresPerSecond(3.75))),
    Sighting("Pursuer", 2, "Evader", 3, None),
    Sighting(
      "Evader",
      4,
      "Pursuer",
      5,
      Some(PredictedMotion(Vector3(0.5, 1.5, -20.25), Vector3(-1, 2.25, 0.5)))
    ),
    MeasurementRow(
      3,
      "Pursuer",
      "gps",
      Vector("latitudeDeg", "it's, odd"),
      Vector(47.6414, -122.25),
      Instant.ofNanos(5_000_001),
      at(50_000_000),
      at(61_000_000)
    ),
    Sensing("Pursuer", 2, "gps", 3),
    image(1),
    cloud(1),
    image(2),
    Planned(
      "Pursuer",
      1,
      40_960,
      Vector(40, 39),
      Some(12.25),
      Span.ofMillis(60.5),
      0,
      Some(PlannedPath(Vector(1.5, 2.5), Vector(-0.5, 0.25), Span.ofMillis(100)))
    ),
    Planned("Pursuer", 2, 0, Vector(0, 0), None, Span.ofMillis(61), 2),
    SolvedRow(
      "Pursuer",
      1,
      4,
      at(41_000_000),
      at(52_000_000),
      Span.ofMillis(1.5),
      Some(SolverClock(Span.ofNanos(-1_000_000_007), Span.ofMillis(4.75)))
    ),
    SolvedRow("Evader", 0, 0, at(41_000_000), at(52_000_000), Span.Zero, None),
    Prediction(
      "Pursuer",
      "Evader",
      at(40_000_000),
      Instant.ofNanos(4_000_001),
      Span.ofMillis(61.5),
      Vector3(21.5, 1.25, -19.75),
      Metres(0.0625)
    ),
    CommandRow(
      1,
      "Pursuer",
      Some(1),
      MetresPerSecond(6.4),
      MetresPerSecond(7.7),
      Metres(-20),
      at(41_000_000)
    ),
    CommandRow(2, "Pursuer", None, MetresPerSecond(0), MetresPerSecond(0), Metres(-20), at(42_000_000)),
    Acknowledgement("Pursuer", 1, at(80_000_000), CommandOutcome.Superseded),
    Acknowledgement("Pursuer", 2, at(81_000_000), CommandOutcome.Done),
    Acknowledgement("Pursuer", 3, at(82_000_000), CommandOutcome.Failed("done too late")),
    Latency("vpn", at(5), Span.ofNanos(102_800_001)),
    Event(at(6), EventKind.Skipped, Some("Evader"), "an answer was outstanding, it's late"),
    Event(at(6), EventKind.DeadlineMissed, Some("Evader"), "decision 5 by the fallback: Late", Some(5)),
    Event(at(7), EventKind.Disconnected, None, ""),
    Event(
      at(8),
      EventKind.Dropped,
      None,
      "3 questions were left at the solver for newer ones",
      about = Some(EventSubject.Solver),
      count = Some(3)
    ),
    Event(
      at(9),
      EventKind.Refused,
      Some("Evader"),
      "front: no image came: unknown",
      about = Some(EventSubject.Camera)
    ),
    Event(
      at(10),
      EventKind.TimedOut,
      Some("Evader"),
      "reading 7: no answer",
      about = Some(EventSubject.Reading)
    ),
    Truth("Evader", Instant.ofNanos(3_000_000), Vector3(21.5, 0.25, -20.125)),
    Ending(at(4_000_000_000L), EndingKind.Failed, Some("the disk is full"))
  )
