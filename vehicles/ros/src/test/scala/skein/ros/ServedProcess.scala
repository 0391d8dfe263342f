package skein.ros

import java.nio.file.Path
import java.util.concurrent.{ConcurrentLinkedQueue, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.DurationInt
import scala.jdk.CollectionConverters.*
import skein.airsim.WorldSettings
import skein.link.{Address, TcpTransport}
import skein.scene.{Placement, Scene, SceneObject, Shape}
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.{Clock, Span, Vector3}

/** A simulator behind ROS 2 in a process of its own, whose environment has the libraries. */
private[ros] final class ServedProcess private (process: Process, val log: () => String):

  /** Ends it, and returns its last words. */
  def close(): String =
    process.getOutputStream.close()
    if !process.waitFor(30, TimeUnit.SECONDS) then
      process.destroyForcibly(): Unit
      throw IllegalStateException(s"it did not end: ${log()}")
    log()

private[ros] object ServedProcess:
  val Names: Vector[String] = Vector("a", "b", "c")

  /** Vehicle `a` starts elsewhere than in the origin, so that its frames differ from the world's. */
  val settings: String = """{ "SettingsVersion": 1.2, "SimMode": "Multirotor", "Vehicles": {
    "a": { "VehicleType": "SimpleFlight", "X": 3, "Y": -2,
      "Cameras": { "front": { "Z": -1, "CaptureSettings": [
        { "ImageType": 0, "Width": 64, "Height": 48, "FOV_Degrees": 90 },
        { "ImageType": 1, "Width": 64, "Height": 48, "FOV_Degrees": 90 },
        { "ImageType": 5, "Width": 64, "Height": 48, "FOV_Degrees": 90 } ] } },
      "Sensors": {
        "spin": { "SensorType": 6, "Enabled": true, "Z": -1, "PointsPerSecond": 20000, "Range": 60,
          "VerticalFOVLower": -1, "VerticalFOVUpper": 1, "DataFrame": "SensorLocalFrame" },
        "fixed": { "SensorType": 6, "Enabled": true, "Z": -1, "PointsPerSecond": 20000, "Range": 60,
          "VerticalFOVLower": -1, "VerticalFOVUpper": 1 } } },
    "b": { "VehicleType": "SimpleFlight", "Y": 4 },
    "c": { "VehicleType": "SimpleFlight", "Y": 8 } } }"""

  /** Starts it, and waits until it serves.
    *
    * @param port port of AirSim's wire
    * @param stepMs interval at which the clock waits for commands, ms; 0: never
    */
  def start(variables: Map[String, String], speed: Double, port: Int, stepMs: Int = 0): ServedProcess =
    start(program(variables, "serveOnRos", speed.toString, port.toString, stepMs.toString))

  /** Starts a program that prints `serving`, and ends when its input does. */
  def start(program: ProcessBuilder): ServedProcess =
    val process = program.start()
    val lines   = ConcurrentLinkedQueue[String]()
    val serving = scala.concurrent.Promise[Boolean]()
    Thread.ofPlatform().daemon().start: () =>
      process.inputReader.lines.iterator.asScala.foreach: line =>
        lines.add(line)
        if line == "serving" then serving.trySuccess(true): Unit
      serving.trySuccess(false): Unit
    def log() = lines.asScala.mkString("\n")
    if !Await.result(serving.future, 60.seconds) then
      throw IllegalStateException(s"it did not start: ${log()}")
    ServedProcess(process, log)

  /** One of the programs of these tests, with a node's environment. */
  def program(variables: Map[String, String], name: String, arguments: String*): ProcessBuilder =
    val java    = Path.of(sys.props("java.home"), "bin", "java").toString
    val command = Seq(java, "--enable-native-access=ALL-UNNAMED", "-Xmx512m") ++
      Seq("-cp", sys.props("java.class.path"), s"skein.ros.$name") ++ arguments
    val builder = ProcessBuilder(command*).redirectErrorStream(true)
    builder.environment.putAll(variables.asJava)
    builder

/** Serves three vehicles to ROS 2 until its input ends; the first has a camera and two lidars before a wall.
  */
@main def serveOnRos(speed: Double, port: Int, stepMs: Int): Unit =
  given system: ActorSystem = ActorSystem("ros")
  val world = WorldSettings.parse(ServedProcess.settings).fold(why => sys.error(why.message), identity)
  val wall  =
    SceneObject("wall", Shape.Box(Vector3(0.5, 200, 20)), Placement(Vector3(33.5, 0, 0)), 0xa04020, None)
  val opened =
    for
      node   <- RosNode.open("skein", Clock.system)
      topics <- SimulatedTopics.open(node, ServedProcess.Names)
    yield (node, topics)
  opened match
    case Left(why) =>
      println(why)
      sys.exit(1)
    case Right((node, topics)) =>
      val settings =
        SimulatorSettings(world, Address("127.0.0.1", port), speed = speed, scene = Scene(Vector(wall)))
      val step    = Option.when(stepMs > 0)(Span.ofMillis(stepMs))
      val started = SimulatorServer.start(settings, TcpTransport(), Clock.system, Some(topics), step)
      val server  = Await.result(started, 20.seconds)
      topics.fly(server).left.foreach(println)
      topics.show(world, server.address).left.foreach(println)
      println("serving")
      while System.in.read() >= 0 do ()
      topics.close()
      node.close()
      println(s"missing: ${topics.missing.mkString("; ")}")
      println(s"notes: ${(node.notes ++ topics.notes).mkString("; ")}")
      println(s"skipped ${topics.skipped}, refused ${node.refused}, failed ${node.failed}")
      Await.result(server.close(), 10.seconds): Unit
      Await.result(system.terminate(), 10.seconds): Unit
      println("ended")
