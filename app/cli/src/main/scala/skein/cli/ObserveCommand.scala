package skein.cli

import java.nio.file.Path
import java.util.concurrent.{CountDownLatch, Executors, TimeUnit}
import mainargs.ParserForClass
import skein.figures.ObservedFigure
import skein.link.*
import skein.observe.*
import skein.report.{ObservedTables, Paragraph, Section, TopicTables}
import skein.ros.RosNode
import skein.rosbag.{BagLoop, GraphLoop}
import skein.units.{Clock, Expect}
import skein.view.Shows

/** `./skein observe`: measures the control loop of any program that flies by AirSim's interface or by
  * MAVLink, from between it and the simulator, or of any graph of ROS 2, by its topics or a bag.
  */
object ObserveCommand
    extends Command[ObserveOptions](
      "observe",
      "measures the loop of any AirSim or MAVLink program, or of a graph or bag of ROS 2: how old its data is",
      ParserForClass[ObserveOptions]
    ):

  protected def execute(options: ObserveOptions): Either[String, Unit] = options.bag match
    case Some(bag)                 => observeBag(Path.of(bag), options)
    case None if options.ros.value => observeGraph(options)
    case None                      => observeProgram(options)

  private def observeBag(bag: Path, options: ObserveOptions): Either[String, Unit] =
    val others = options.ofWire ++ Option.when(options.ros.value)("--ros") ++
      Option.when(options.view.view.value)("--view") ++
      Option.when(options.command.words.nonEmpty)("a program")
    for
      _ <- Expect.that(others.isEmpty):
        s"--bag: the bag is measured, and no program; got ${others.mkString(", ")} too"
      folder   <- folderOf(options)
      observed <- BagLoop(options.readings.toSet, options.commands.toSet).observed(bag)
      _        <- show(observed, TopicTables.findings(observed), folder, options)
    yield ()

  private def observeGraph(options: ObserveOptions): Either[String, Unit] =
    for
      _ <- Expect.that(options.ofWire.isEmpty):
        s"--ros: topics are measured, and no simulator's wire; got ${options.ofWire.mkString(", ")} too"
      _      <- RosNode.missing.toLeft(()).left.map("--ros: " + _)
      folder <- folderOf(options)
      shows = Shows()
      _ <- options.view.serving(shows)(observeGraph(options, folder, shows))
    yield ()

  private def observeGraph(
      options: ObserveOptions,
      folder: Option[Path],
      shows: Shows
  ): Either[String, Unit] =
    val command = options.command.words
    for
      loop <- GraphLoop.open(options.readings.toSet, options.commands.toSet, Clock.system)
        .left.map("--ros: " + _)
      findings = () => { val now = loop.observed; (now, TopicTables.findings(now) ++ loop.remarks) }
      ended    =
        Shown(options.json.value)
          .say("measuring topics of ROS 2" + (if command.isEmpty then "; Ctrl-C ends it" else ""))
        try
          viewing(shows, "topics", "ROS 2", loop.takeNew, () => findings()._2):
            telling(loop.progress)(untilEnd(options))
        finally loop.close()
      _ <- ended
      (observed, found) = findings()
      _ <- show(observed, found, folder, options)
    yield ()

  /** Shows the loop to viewers until `body` has ended. */
  private def viewing[A](
      shows: Shows,
      what: String,
      where: String,
      takeNew: () => Vector[NewCommands],
      findings: () => Vector[String]
  )(body: => A): A =
    val shown = LoopOnShow(takeNew, findings, Clock.system)
    shown.show(shows, what, where)
    try body
    finally shown.end()

  private def show(
      observed: ObservedTopics,
      findings: Vector[String],
      folder: Option[Path],
      options: ObserveOptions
  ): Either[String, Unit] =
    val shown = Shown(options.json.value)
    val data  = TopicTables.data(observed, findings)
    shown.tables(data, text(TopicTables.tables(observed), findings))
    folder.fold(Right(()))(write(data, observed.log, observed.vehicles, _, shown))

  private def folderOf(options: ObserveOptions): Either[String, Option[Path]] =
    Expect.optional(options.out)(OutFolder.made("--out", _))

  private def observeProgram(options: ObserveOptions): Either[String, Unit] =
    val isMavlink = options.mavlink.value
    val isTcp     = !isMavlink || options.simulator.exists(_.startsWith(Tcp))
    val unknown   = options.readings.find(!MavlinkLoop.Readings.contains(_))
    for
      _ <- Expect.that(isMavlink || options.readings.isEmpty):
        "--readings: expected with --bag, --ros or --mavlink alone"
      _ <- Expect.that(options.commands.isEmpty)("--commands: expected with --bag or --ros alone")
      _ <- Expect.that(!isMavlink || unknown.isEmpty):
        s"--readings: expected ${MavlinkLoop.Readings.mkString(", ")}, got ${unknown.get}"
      usual = if isMavlink then (14680, 14580) else (41452, 41451)
      listenAt  <- address("--listen", options.listen, usual._1)
      simulator <-
        address(
          "--simulator",
          options.simulator.map(at => if isMavlink then at.stripPrefix(Tcp) else at),
          usual._2
        )
      there <- Reachable.from(simulator).toRight(s"--simulator: the host ${simulator.host} is not known")
      _     <- Expect.that(listenAt.port == 0 || !Reachable.from(listenAt).contains(there)):
        s"--listen: expected another address than the simulator's, got $listenAt twice"
      profile <- Arguments.latency(options.link).left.map("--link: " + _)
      folder  <- folderOf(options)
      shows = Shows()
      wire  = Wire(listenAt, simulator, LinkProfile.symmetric(profile), isTcp, shows)
      _ <- options.view.serving(shows):
        if isMavlink then observeMavlink(wire, folder, options) else observeAirSim(wire, folder, options)
    yield ()

  private def address(option: String, text: Option[String], usualPort: Int): Either[String, Address] =
    text.fold(Right(Address("127.0.0.1", usualPort)))(Address.parse).left.map(s"$option: " + _)

  private def observeMavlink(
      wire: Wire,
      folder: Option[Path],
      options: ObserveOptions
  ): Either[String, Unit] =
    val loop = MavlinkLoop(isDatagrams = !wire.isTcp, options.readings.toSet)
    for
      (observed, ended) <- observe(loop, wire, options)(TopicTables.findings)
      _                 <- show(observed, TopicTables.findings(observed) ++ loop.remarks, folder, options)
      _                 <- ended
    yield ()

  private def observeAirSim(wire: Wire, folder: Option[Path], options: ObserveOptions): Either[String, Unit] =
    val shown = Shown(options.json.value)
    for
      (observed, ended) <- observe(AirSimAnalysis(), wire, options)(ObservedTables.findings)
      data = ObservedTables.data(observed)
      _    = shown.tables(data, text(ObservedTables.tables(observed), ObservedTables.findings(observed)))
      _ <- ended
      _ <- folder.fold(Right(()))(write(data, observed.log, observed.vehicles, _, shown))
    yield ()

  private def write(
      tables: Vector[Section],
      log: Vector[ObservedCommand],
      vehicles: Vector[ObservedVehicle],
      folder: Path,
      shown: Shown
  ): Either[String, Unit] =
    val picture =
      ObservedFigure(vehicles).fold(Vector.empty)(OutFolder.picture("ages", _, "how old a loop's data is"))
    OutFolder
      .write(
        folder,
        Vector(
          OutFolder.text("observed.json", Section.json(tables)),
          OutFolder.text("commands.csv", ObservedTables.csv(log))
        ) ++ picture
      )
      .map(files => shown.say(s"written: ${files.mkString(", ")}"))

  /** The addresses of a program and its simulator, and the link between them. */
  private final case class Wire(
      listenAt: Address,
      simulator: Address,
      profile: LinkProfile,
      isTcp: Boolean,
      shows: Shows
  )

  /** Observes until the program ends.
    *
    * @param findings the findings of an observation, for the page
    * @return Left if it could not begin; else the observations, and whether the program could be run
    */
  private def observe[A](
      analysis: Analysis[A],
      wire: Wire,
      options: ObserveOptions
  )(findings: A => Vector[String]): Either[String, (A, Either[String, Unit])] =
    import wire.*
    val reader                  = Executors.newSingleThreadExecutor(Thread.ofPlatform().daemon().factory())
    val shown                   = Shown(options.json.value)
    def warn(reason: Throwable) = Console.err.println(s"skein observe: ${reason.getMessage}")
    Edge.withSystem("skein", ObservingProxy.Settings):
      try
        val link  = EmulatedLink(profile, options.seed, Clock.system)
        val proxy = Edge.await(
          ObservingProxy.start(
            analysis,
            listenAt,
            simulator,
            link,
            if isTcp then TcpTransport() else UdpTransport(),
            Clock.system,
            reader,
            unreachable = warn,
            isDatagrams = !isTcp
          )
        )
        val command = options.command.words
        shown.say(
          s"${proxy.address} leads to $simulator" +
            (if profile == LinkProfile.none then "" else s" over ${profile.toServer.name}") +
            (if command.isEmpty then "; connect your program there, Ctrl-C ends it" else "")
        )
        val ended =
          viewing(
            shows,
            "a program's loop",
            simulator.toString,
            proxy.takeNew,
            () => findings(proxy.observed)
          ):
            telling(proxy.progress)(untilEnd(options))
        if command.nonEmpty then Edge.await(proxy.ended()): Unit
        Edge.await(proxy.close())
        Right((proxy.observed, ended))
      finally reader.shutdown()

  /** Prints the progress every few seconds until `body` ends. */
  private def telling[A](progress: => Progress)(body: => A): A =
    val timer = Executors.newSingleThreadScheduledExecutor(Thread.ofPlatform().daemon().factory())
    timer.scheduleWithFixedDelay(
      () => ObservedTables.line(progress).foreach(Console.err.println),
      TellEveryS,
      TellEveryS,
      TimeUnit.SECONDS
    ): Unit
    try body
    finally timer.shutdown()

  private def untilEnd(options: ObserveOptions): Either[String, Unit] =
    val command = options.command.words
    if command.isEmpty then untilInterrupted()
    else
      InTerminal.run(command, forScripts = options.json.value).map: status =>
        if status != 0 then
          Console.err.println(s"skein observe: ${command.head} ended with exit status $status")

  private def untilInterrupted(): Either[String, Unit] =
    val stopped = CountDownLatch(1)
    Edge.untilInterrupted(() => stopped.countDown())(stopped.await())
    Right(())

  private def text(tables: Vector[Section], findings: Vector[String]): String =
    (Section.text(tables) +: "" +: findings.flatMap(Paragraph.lines(_, 100))).mkString("\n")

  private val TellEveryS = 5L
  private val Tcp        = "tcp://"
