package skein.flight

import java.nio.charset.StandardCharsets.ISO_8859_1
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.airsim.{AirSimClient, Multirotor, VehicleSettings, WorldSettings}
import skein.link.*
import skein.loop.{LoopKind, FlightOutcome}
import skein.measure.FlightSummary
import skein.record.{CameraImage, EndingKind, EventKind, MemoryRecorder, Recording}
import skein.rpc.RpcClient
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings, ImageSource}
import skein.signal.{Kinematics, LatencyProfile}
import skein.simulator.{SimulatedSensing, SimulatorServer, SimulatorSettings}
import skein.testing.Unhurried
import skein.units.*
import skein.vehicle.SensorNoise
import skein.vtime.VirtualTime

/** Flights against a simulator that was started before and continues afterwards, as AirSim does. */
class RunningSimulatorSimulation extends munit.FunSuite, Unhurried:
  private val settings = FlySettings(
    List(LoopKind.Stream, LoopKind.Paused, LoopKind.Predictive),
    List(LatencyProfile.direct),
    duration = Span.ofSeconds(8),
    period = Span.ofMillis(100),
    seed = 1
  )

  private val brief = settings.copy(loops = List(LoopKind.Stream), duration = Span.ofSeconds(2))

  private val duel = Vector(
    VehicleSettings("Evader", Vector3(0, 0, 0), Radians(0)),
    VehicleSettings("Pursuer", Vector3(-20, 5, 0), Radians(0))
  )

  /** A running simulator in virtual time, with its clients. */
  private final class Bench(
      vehicles: Vector[VehicleSettings],
      losesCancel: () => Boolean,
      sensors: Option[SensorNoise]
  )(using
      val system: ActorSystem
  ):
    import system.dispatcher
    private val clock   = Clock.ofNanos(VirtualTime.clock(system))
    private val network = MemoryNetwork(NetworkPlan(), 1, clock).host("localhost")
    private val world   = SimulatorSettings(
      WorldSettings.of(vehicles),
      Address("127.0.0.1", 0),
      losesCancel = losesCancel,
      sensing = sensors.map(SimulatedSensing(_))
    )
    val server: Future[SimulatorServer] = SimulatorServer.start(world, Tapped(network), clock)

    /** Calls by which clients took control that a vehicle did not have. */
    var taken = Vector.empty[String]

    /** Requests to a camera that were received; the first is lost. */
    var cameraQuestions = 0

    /** Lines that were reported to the user. */
    var told = Vector.empty[String]

    var images = Vector.empty[CameraImage]

    private final class Tapped(transport: Transport) extends Transport:
      def connect(to: Address) = transport.connect(to)
      def listen(at: Address)  = transport.listen(at).map: incoming =>
        incoming.copy(flow = incoming.flow.map: bytes =>
          val text = bytes.decodeString(ISO_8859_1)
          taken ++= Seq("enableApiControl", "armDisarm", "takeoff").filter(text.contains)
          if text.contains("simGetCameraInfo") then cameraQuestions += 1
          if text.contains("simGetCameraInfo") && cameraQuestions == 1 then ByteString.empty else bytes)

    /** Flies plans in sequence, like one command. */
    def command(
        settings: FlySettings,
        onStart: () => Unit = () => (),
        calledOff: String => Option[String] = _ => None
    ): Future[Either[String, Vector[Recording]]] =
      server.flatMap: server =>
        val assembler =
          FlightAssembler(
            network,
            clock,
            settings,
            Some(server.address),
            tell = line => told :+= line,
            calledOff = calledOff
          )
        settings.plans.foldLeft(Future.successful[Either[String, Vector[Recording]]](Right(Vector.empty))):
          (before, plan) =>
            before.flatMap:
              case Left(reason)      => Future.successful(Left(reason))
              case Right(recordings) => fly(assembler, plan, onStart).map(_.map(recordings :+ _))

    private def fly(
        assembler: FlightAssembler,
        plan: FlightPlan,
        onStart: () => Unit
    ): Future[Either[String, Recording]] =
      val recorder = MemoryRecorder(assembler.heading(plan, "virtual"))
      assembler
        .start(plan, recorder)
        .flatMap:
          case Left(reason)    => Future.successful(Left(s"${plan.id}: $reason"))
          case Right(assembly) =>
            onStart()
            assembly.landed.map(landed =>
              images = recorder.records.collect { case image: CameraImage => image }.toVector
              Either.cond(
                landed.outcome == FlightOutcome.Completed,
                recorder.recording,
                s"${plan.id}: ${landed.outcome}"
              )
            )

    def missing(sensors: Option[SensorNoise]): Future[Either[String, Unit]] = server.flatMap: server =>
      AirSimFleet.missing(settings.fleet, sensors, server.address, network, clock)

    /** Every vehicle's state in its own frame, at every tick until `done`. */
    def watch(done: Future[?]): Future[Vector[Vector[Kinematics]]] = operate: client =>
      val watched = vehicles.map(vehicle => Multirotor(client, vehicle.name))
      def more(seen: Vector[Vector[Kinematics]]): Future[Vector[Vector[Kinematics]]] =
        Future
          .traverse(watched)(_.groundTruth().map(_.fold(e => fail(e.message), identity)))
          .flatMap: now =>
            if done.isCompleted then Future.successful(seen :+ now) else after(50.millis)(more(seen :+ now))
      more(Vector.empty)

    def operate[A](act: AirSimClient => Future[A]): Future[A] =
      server.flatMap: server =>
        val client = AirSimClient(RpcClient(network, server.address, clock))
        act(client).flatMap(done => client.close().map(_ => done))

  private def on[A](
      vehicles: Vector[VehicleSettings],
      losesCancel: () => Boolean = () => false,
      sensors: Option[SensorNoise] = None
  )(
      use: Bench => Future[A]
  ): A = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val bench = Bench(vehicles, losesCancel, sensors)
      for
        result <- use(bench)
        server <- bench.server
        _      <- server.close()
      yield result
    .value

  private def firstSeen(recording: Recording, vehicle: String): Kinematics =
    recording.readings.filter(_.vehicle == vehicle).minBy(_.sequence).state.value

  private def assertBeginsAtRest(recording: Recording): Unit =
    for vehicle <- recording.heading.vehicles do
      val first = firstSeen(recording, vehicle.name)
      val off   = (first.positionNed - vehicle.startNed).norm
      assert(off <= 0.3, s"${recording.flight.id}, ${vehicle.name}: $off m off its start")
      assert(first.velocityNed.norm <= 0.1, s"${recording.flight.id}, ${vehicle.name}: $first")

  private def orFail[A](result: Either[String, A]): A = result.fold(fail(_), identity)

  test(
    "consecutive flights, of one command or several, begin at rest at the starts, and no vehicle falls"
  ):
    val (recordings, seen, atFirst, inAll) = on(duel): bench =>
      import bench.system.dispatcher
      for
        first <- bench.command(settings.copy(loops = settings.loops.take(1))).map(orFail)
        atFirst = bench.taken
        later   = bench.command(settings.copy(seed = 2)).map(orFail)
        seen   <- bench.watch(later)
        second <- later
      yield (first ++ second, seen, atFirst, bench.taken)
    assertEquals(recordings.size, 4)
    recordings.foreach(assertBeginsAtRest)
    val lowest = seen.flatten.map(_.positionNed.z).max
    assert(lowest < -16, s"a vehicle came down to $lowest m")
    assertEquals(
      atFirst.sorted,
      Vector("armDisarm", "enableApiControl", "takeoff").flatMap(Vector.fill(2)(_))
    )
    assertEquals(inAll, atFirst, "taken of vehicles that flew under api control")

  test("vehicles with another heading turn north before they hover at their starts"):
    val turned = duel.zip(Seq(99.0, -150.0)).map((one, deg) => one.copy(yaw = Radians(math.toRadians(deg))))
    for recording <- orFail(on(turned)(_.command(brief))) do
      assertBeginsAtRest(recording)
      for vehicle <- duel do
        val q = firstSeen(recording, vehicle.name).orientation
        assert(math.abs(2 * math.atan2(q.z, q.w)) < math.toRadians(4), s"$vehicle: $q")

  test("a falling vehicle, and one whose last move still runs, are brought to their starts"):
    val recordings = on(duel): bench =>
      import bench.system.dispatcher
      for
        first <- bench.command(brief).map(orFail)
        _     <- bench.operate(Multirotor(_, "Evader").enableApiControl(false))
        _ = bench.operate(Multirotor(_, "Pursuer").moveByVelocity(Vector3(3, -4, -1), Span.ofSeconds(8)))
        _      <- after(300.millis)(Future.unit)(using bench.system)
        second <- bench.command(brief.copy(seed = 2)).map(orFail)
      yield first ++ second
    assertEquals(recordings.size, 2)
    recordings.foreach(assertBeginsAtRest)

  test("altitudes count from each vehicle's start, wherever its frame has its origin"):
    val truth            = settings.copy(loops = List(LoopKind.Paused))
    def flown(z: Double) = on(duel.map(one => one.copy(startNed = one.startNed.copy(z = z)))): bench =>
      import bench.system.dispatcher
      for
        recordings <- bench.command(truth).map(orFail)
        own        <- bench.watch(Future.unit)
      yield (recordings.head, own.head)
    val (level, _)    = flown(0)
    val (raised, own) = flown(-2)
    assertBeginsAtRest(raised)
    for state <- own do assertEqualsDouble(state.positionNed.z, -20, 1.5)
    def apartM(recording: Recording) =
      val last = recording.decisions.last
      last.own.state.value.positionNed.horizontalDistance(last.opponent.state.value.positionNed)
    assertEqualsDouble(apartM(raised), apartM(level), 0.1)

  test(
    "flights by readings with errors begin where the vehicles truly are, and errors are no other client's"
  ):
    val noise   = SensorNoise.parse("position=1,velocity=0.3,heading=0.1,dropout=20%,outage=1s/4s").toOption
    val flights = on(duel, sensors = noise)(_.command(settings.copy(sensors = noise)))
    for recording <- orFail(flights) do
      assertEquals(recording.ending.map(_.how), Some(EndingKind.Completed))
      assert(recording.readings.sizeIs > 60, recording.readings.size)

  test("by readings with errors, too, vehicles take off and climb vertically to their layers"):
    val noise         = SensorNoise.parse("velocity=0.3,drift=30/60s").toOption
    val (seen, taken) = on(duel, sensors = noise): bench =>
      import bench.system.dispatcher
      val flown = bench.command(brief.copy(sensors = noise)).map(orFail)
      bench.watch(flown).zip(flown).map((seen, _) => (seen, bench.taken))
    assertEquals(taken.count(_ == "takeoff"), 2)
    for vehicle <- duel.indices do
      val rising = seen.map(_(vehicle).positionNed).takeWhile(_.z > -15)
      assert(rising.nonEmpty && rising.last.z < -10, rising.lastOption)
      val sideways = rising.map(place => place.copy(z = 0).norm).max
      assert(sideways < 1, s"$sideways m")

  test("a simulator of other sensors than stated is refused"):
    val noise                 = SensorNoise.parse("position=1,velocity=0.1").toOption
    def against(text: String) = on(duel, sensors = noise): bench =>
      bench.missing(Option(text).filter(_.nonEmpty).flatMap(SensorNoise.parse(_).toOption))
    assertEquals(against("velocity=0.1,position=1.0"), Right(()))
    for text <- Seq("", "position=2,velocity=0.1") do
      assert(
        against(text).left.exists(why =>
          why.startsWith("--sensors: expected position=1,velocity=0.1, as in the simulator at ")
        )
      )

  test("a simulator that stands still is resumed"):
    val recordings = on(duel): bench =>
      import bench.system.dispatcher
      bench.operate(_.pause()).flatMap(_ => bench.command(brief))
    orFail(recordings).foreach(assertBeginsAtRest)

  for loop <- Seq(LoopKind.Stream, LoopKind.Predictive, LoopKind.Futures) do
    test(s"${loop.label}: within a second after a lost cancel, moves are answered in time again"):
      var lost    = 0
      var mayLose = false
      def loses() =
        val now = mayLose && lost == 0
        if now then lost += 1
        now
      val flown = orFail(on(duel, () => loses()): bench =>
        import bench.system.dispatcher
        def soon() = bench.system.scheduler.scheduleOnce(5.seconds)({ mayLose = true }): Unit
        bench.command(settings.copy(loops = List(loop), duration = Span.ofSeconds(20)), () => soon())).head
      assertEquals(lost, 1)
      val late = answeredLate(flown)
      assert(late.nonEmpty, "nothing was late: was the cancel lost?")
      assert(
        late.max.since(late.min) < Span.ofSeconds(1),
        s"${late.size} late, from ${late.min} to ${late.max}"
      )
      val told =
        flown.events.filter(event => event.kind == EventKind.TimedOut && event.detail.contains("cancel"))
      assertEquals(told.size, 1, told.toString)

  /** Times of moves whose predecessors were answered more than 300 ms later. */
  private def answeredLate(recording: Recording): Vector[Instant] =
    val ended = recording.acknowledgements.map(ack => (ack.vehicle, ack.command) -> ack.endedAt).toMap
    for
      vehicle <- recording.heading.vehicles.toVector
      commands = recording.commands.filter(_.vehicle == vehicle.name)
      (one, next) <- commands.zip(commands.drop(1))
      if ended.get((one.vehicle, one.sequence)).exists(_.since(next.sentAt) > Span.ofMillis(300))
    yield next.sentAt

  test(
    "a flight that is called off while its vehicles move to their starts lets them hover on the way"
  ):
    val (outcome, seen) = on(duel): bench =>
      import bench.system.dispatcher
      given ActorSystem = bench.system
      val requests      = OutsideRequests()
      requests.stop("another", "not this one")
      after(5.seconds)(Future.successful(requests.stop("stream-direct", "ended from the page"))): Unit
      val flown = bench.command(brief, calledOff = requests.calledOff)
      // Long enough to show any remaining motion.
      bench.watch(flown.flatMap(_ => after(10.seconds)(Future.unit))).zip(flown).map((seen, flown) =>
        (flown, seen)
      )
    assertEquals(outcome.map(_.size), Left("stream-direct: ended from the page"))
    val high = seen.map(_.map(-_.positionNed.z).max)
    assert(high.max > 2 && high.max < 15, s"the highest were at ${high.max} m")
    assert(seen.last.forall(_.velocityNed.norm < 0.3), seen.last)

  test("a flight whose simulator is reset by another client on the way to the starts reports that"):
    val outcome = on(duel): bench =>
      import bench.system.dispatcher
      given ActorSystem = bench.system
      val flown         = bench.command(brief)
      after(5.seconds)(bench.operate(_.reset())).zip(flown).map(_._2)
    val told = outcome.map(_.size).left.getOrElse("it flew")
    assert(
      told.contains(
        "no longer gives Evader to this flight: it was started again or reset, or another client took api " +
          "control away"
      ),
      told
    )

  test("a camera's field of view is requested again if the request was lost"):
    val filmed          = brief.copy(images = List(ImageSource.Camera("front_center", 5)))
    val (asked, images) = on(duel): bench =>
      import bench.system.dispatcher
      bench.command(filmed).map(orFail).map(_ => (bench.cameraQuestions, bench.images))
    assertEquals(asked, 3)
    for vehicle <- Seq("Pursuer", "Evader") do
      val lenses = images.filter(_.vehicle == vehicle).map(_.fov)
      assert(lenses.last.isDefined, s"$vehicle: $lenses")

  test("a flight with a missing vehicle is refused, with the names of the existing ones"):
    assertEquals(
      on(duel.take(1))(_.command(settings)).left.map(_.replaceFirst("^[^:]*: ", "")),
      Left("the simulator has no vehicle 'Pursuer'; it has 'Evader'")
    )

  test("a camera without any image is reported with the reason, also in the summary"):
    val filmed        = brief.copy(images = List(ImageSource.Camera("nose", 5)))
    val (told, flown) = on(duel): bench =>
      import bench.system.dispatcher
      bench.command(filmed).map(orFail).map(flights => (bench.told, flights.head))
    val lines = told.filter(_.contains("no image came"))
    assertEquals(lines.size, 2, told.mkString("\n"))
    assert(lines.forall(_.contains("No camera with name nose exist on vehicle")), lines)
    val summary = FlightSummary.of(flown)(using Scenarios.ours)
    assertEquals(summary.imageless.size, 2)
    assert(
      summary.imageless.head.contains("'s camera nose: no image came: simGetImages: refused by the peer: ")
    )
