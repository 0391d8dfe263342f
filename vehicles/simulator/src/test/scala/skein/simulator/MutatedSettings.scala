package skein.simulator

import java.lang.management.ManagementFactory
import scala.util.Random

/** Settings files, changed in a few places: each is read, or refused in one line. */
private[simulator] object MutatedSettings:

  /** Counts of the files by their results.
    *
    * @param longestMs greatest processor time for one file
    * @param slowest seed of that file
    */
  final case class Figures(read: Int, refused: Int, longestMs: Double, slowest: Long)

  def run(files: Int, seed: Long): Figures =
    val threads         = ManagementFactory.getThreadMXBean
    var (read, refused) = (0, 0)
    var longest         = 0L
    var slowest         = seed
    for number <- 0 until files do
      val text  = mutated(Random(seed + number))
      val begun = threads.getCurrentThreadCpuTime
      try
        SettingsFile.read(text) match
          case Right(file) =>
            read += 1
            file.notice.foreach(assertLine)
            // The settings must be usable.
            Simulation(SimulatorSettings(file.world), skein.units.Instant.Epoch)
              .advance(skein.units.Instant.ofNanos(10_000_000)): Unit
          case Left(error) =>
            refused += 1
            assertLine(error.message)
      catch case error: Throwable => throw AssertionError(s"seed ${seed + number}: $text", error)
      val spent = threads.getCurrentThreadCpuTime - begun
      if spent > longest then
        longest = spent
        slowest = seed + number
    Figures(read, refused, longest / 1e6, slowest)

  private def assertLine(line: String): Unit =
    require(line.nonEmpty && line.length < 5000 && !line.exists(_.isControl), line.take(6000))

  private def mutated(random: Random): String =
    (0 to random.nextInt(3)).foldLeft(Whole)((text, _) => change(text, random))

  /** Changes a text as users do by mistake: letters, cuts, and other values in place of one. */
  private def change(text: String, random: Random): String =
    if text.isEmpty then "{}"
    else
      val at = random.nextInt(text.length)
      random.nextInt(9) match
        case 0     => text.updated(at, random.nextPrintableChar())
        case 1     => text.take(at)
        case 2     => text.patch(at, "", (1 + random.nextInt(20)).min(text.length - at))
        case 3     => text.patch(at, text.slice(at, at + random.nextInt(200)), 0)
        case 4     => text.updated(at, random.nextInt(0x3000).toChar)
        case 5 | 6 =>
          // A key of another name has no effect.
          val keys = """"[A-Za-z0-9]+":""".r.findAllMatchIn(text).toVector
          if keys.isEmpty then text else text.patch(keys(random.nextInt(keys.size)).start + 1, "My", 0)
        case _ =>
          val values = """-?[0-9][0-9.]*|true|false|"[^"]*"""".r.findAllMatchIn(text).toVector
          if values.isEmpty then text
          else
            val one = values(random.nextInt(values.size))
            text.patch(one.start, Values(random.nextInt(Values.size)), one.end - one.start)

  private val Values = Vector(
    "null",
    "[]",
    "{}",
    "-1",
    "0",
    "1e999",
    "-1e400",
    "1e308",
    "NaN",
    "0.5",
    "4294967296",
    "true",
    "\"\"",
    "\"Car\"",
    "\"ComputerVision\"",
    "\"\\u0000\\n\"",
    "[" * 5000 + "]" * 5000,
    "{\"a\":" * 3000 + "1" + "}" * 3000,
    s"\"${"x" * 20_000}\"",
    s"${"9" * 5000}",
    "[{}, {}, 3]"
  )

  private val Whole =
    """{"SettingsVersion": 1.2, "SimMode": "Multirotor", "ClockSpeed": 1, "ViewMode": "Fpv",
    "ApiServerPort": 41451, "LocalHostIp": "127.0.0.1", "Wind": {"X": 1, "Y": 0, "Z": 0}, "RpcEnabled": true,
    "OriginGeopoint": {"Latitude": 47.6, "Longitude": -122.1, "Altitude": 122},
    "SubWindows": [{"WindowID": 0, "ImageType": 3, "CameraName": "0", "Visible": false}],
    "Recording": {"RecordOnMove": false, "RecordInterval": 0.05, "Cameras": []},
    "CameraDefaults": {"CaptureSettings": [{"ImageType": 0, "Width": 64, "Height": 48, "FOV_Degrees": 90}]},
    "PawnPaths": {"DefaultQuadrotor": {"PawnBP": "Class'/AirSim/Blueprints/BP_FlyingPawn.BP_FlyingPawn_C'"}},
    "DefaultSensors": {"L": {"SensorType": 6, "Enabled": true, "NumberOfChannels": 4, "PointsPerSecond": 1000},
      "D": {"SensorType": 5, "Enabled": true, "MinDistance": 0.2, "MaxDistance": 40}, "G": {"SensorType": 3}},
    "Vehicles": {"A": {"VehicleType": "SimpleFlight", "X": 0, "Y": 0, "Z": -2, "Yaw": 90, "AutoCreate": true,
        "DefaultVehicleState": "Armed", "EnableTrace": false, "RC": {"RemoteControlID": 0},
        "Cameras": {"c": {"X": 0.5, "Pitch": -10, "CaptureSettings": [{"ImageType": 1, "Width": 32}]}},
        "Sensors": {"L2": {"SensorType": 6, "Enabled": true, "Range": 50, "DataFrame": "SensorLocalFrame"}}},
      "B": {"VehicleType": "PhysXCar", "X": 10, "IsFpvVehicle": true},
      "C": {"VehicleType": "ComputerVision", "Y": 4, "AutoCreate": false}}}"""

/** Prints the results of mutated settings files: `settingsFuzz [FILES [SEED]]`. */
@main def settingsFuzz(arguments: String*): Unit =
  val files = arguments.headOption.fold(2000)(_.toInt)
  val seed  = arguments.lift(1).fold(1L)(_.toLong)
  MutatedSettings.run(20, seed - 20): Unit // classes are loaded once
  println(MutatedSettings.run(files, seed))
