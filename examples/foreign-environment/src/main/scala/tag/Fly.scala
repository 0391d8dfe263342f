package tag

import java.nio.file.{Files, Path}
import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext}
import skein.flight.{EnvironmentProcess, EnvironmentSimulator, LinkedVehicle, PortFlight}
import skein.loop.{LoopKind, LoopSettings}
import skein.record.{ClockKind, DuckDbRecorder, Recording, RecordingReader}
import skein.report.{Report, ReportSections}
import skein.scenario.{ScenarioKind, Scenarios, Surround}
import skein.signal.LatencyProfile
import skein.units.*
import skein.vehicle.ConstantVelocity

/** Three pursuers encircle an evader, in the world behind the socket. */
val scenario = Surround(vehicles = 4, ringM = 5, pursuerMps = 10, evaderMps = 5)

/** Runs it paused, as its truth, and with four loops over the paper's VPN; writes recordings and a report.
  *
  * @param path of the environment's socket
  */
@main def fly(path: String, folder: String): Unit =
  given system: ActorSystem = ActorSystem("tag")
  given Scenarios           = Scenarios(ScenarioKind(scenario))
  val flights               = (LoopKind.Paused, LatencyProfile.none) +:
    Vector(
      LoopKind.Sequential,
      LoopKind.Futures,
      LoopKind.Stream,
      LoopKind.Predictive
    ).map((_, LatencyProfile.vpn))
  Files.createDirectories(Path.of(folder)): Unit
  try
    val files = flights.map((loop, link) => flown(path, Path.of(folder), loop, link))
    val shown =
      for
        set    <- Report.read(files).left.map(_.map(_.message).mkString("\n"))
        report <- Report.write(set, Path.of(folder))
      yield println(s"${ReportSections.text(set)}\n\n${returns(files)}\n\nreport in ${report.page}")
    shown.fold(sys.error, identity)
  finally system.terminate(): Unit

private def flown(path: String, folder: Path, loop: LoopKind, link: LatencyProfile)(using
    system: ActorSystem
): Path =
  import system.dispatcher
  val names    = scenario.agents.map(_.name)
  val clock    = Clock.system
  val settings = LoopSettings.every(Span.ofMillis(100)).copy(model = _ => ConstantVelocity)
  val id       = s"${loop.label}-${link.name}"
  val flight   =
    PortFlight(
      id,
      loop,
      scenario,
      Span.ofSeconds(30),
      ClockKind.Real,
      clock,
      settings,
      link.name,
      "simple_tag"
    )
  val file   = folder.resolve(s"$id.duckdb")
  val thread = Executors.newSingleThreadExecutor(Thread.ofPlatform.daemon.factory)
  val on     = ExecutionContext.fromExecutorService(thread)
  println(s"flying $id")
  def or[A](result: Either[String, A]) = result.fold(sys.error, identity)
  val process                          = or(EnvironmentProcess.connect(path, names))
  try
    val landed =
      for
        recorder <- DuckDbRecorder.open(file, flight.heading).map(_.left.map(_.message)).map(or)
        simulator = or(EnvironmentSimulator.start(process, names, clock, recorder, on))
        vehicles  = simulator.vehicles.zipWithIndex.map((vehicle, number) =>
          if link == LatencyProfile.none then vehicle
          else LinkedVehicle(vehicle, link, seed = 1, number, clock)
        )
        landed <- flight.start(vehicles, recorder, Some(simulator)).landed
      yield landed
    println(s"ended: ${Await.result(landed, 2.minutes).outcome}")
    file
  finally
    thread.shutdown()
    process.close()

/** Sums of each vehicle's rewards, as a table. */
private def returns(files: Vector[Path]): String =
  def of(recording: Recording) = scenario.agents.map: agent =>
    val steps = recording.measurements.filter(row =>
      row.vehicle == agent.name && row.sensor == EnvironmentSimulator.Sensor
    )
    s"${agent.name} ${steps.map(_.numbers.head).sum.round}"
  files
    .flatMap(file => RecordingReader.read(file).toOption)
    .map(recording => s"${recording.flight.id}: ${of(recording).mkString(", ")}")
    .mkString("rewards, summed over the flight\n", "\n", "")
