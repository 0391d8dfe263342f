package skein.simulator

import skein.airsim.wire.{Pose, Vector3r}
import skein.simulator.Appearance.{Line, Marker, Sun, Trace}

/** Functions whose effect only an eye would notice. What they say is kept; what they would change of things that do not
  * exist here (lights, textures, materials) they do not change, and say so as AirSim does of a name it does not know.
  */
private[simulator] object AppearanceMethods:
  import Method.*

  val all: Seq[Method] = Seq(
    one[Boolean]("simEnableWeather"): (simulation, on) =>
      simulation.appearance.weather = on
      Nil
    ,
    many[(Int, Float)]("simSetWeatherParameter"):
      case (simulation, (effect, strength)) =>
        if effect < 0 || effect > LastEffect then
          Outcome.Threw(s"a weather parameter is 0 to $LastEffect, not $effect")
        else
          simulation.appearance.effects(effect) = strength
          Nil
    ,
    many[(Boolean, String, Boolean, Float, Float, Boolean)]("simSetTimeOfDay"):
      case (simulation, (on, start, daylightSaving, speed, interval, moves)) =>
        bounded(start):
          simulation.appearance.sun = Option.when(on)(Sun(start, daylightSaving, speed, interval, moves))
          Nil
    ,
    none("simFlushPersistentMarkers"): simulation =>
      simulation.appearance.flushPersistent()
      Nil
    ,
    plot("simPlotPoints"),
    plot("simPlotLineStrip"),
    plot("simPlotLineList"),
    many[(Seq[Vector3r], Seq[Vector3r], Seq[Float], Float, Float, Float, Boolean)]("simPlotArrows"):
      case (simulation, (from, to, colour, _, _, duration, persistent)) =>
        paired("points_start and points_end", from, to):
          draw(simulation, "simPlotArrows", from ++ to, Seq.empty, colour, duration, persistent)
    ,
    many[(Seq[String], Seq[Vector3r], Float, Seq[Float], Float)]("simPlotStrings"):
      case (simulation, (texts, points, _, colour, duration)) =>
        paired("strings and positions", texts, points):
          draw(simulation, "simPlotStrings", points, texts, colour, duration, persistent = false)
    ,
    many[(Seq[Pose], Float, Float, Float, Boolean)]("simPlotTransforms"):
      case (simulation, (poses, _, _, duration, persistent)) =>
        draw(simulation, "simPlotTransforms", poses.map(_.position), Seq.empty, Axes, duration, persistent)
    ,
    many[(Seq[Pose], Seq[String], Float, Float, Float, Seq[Float], Float)]("simPlotTransformsWithNames"):
      case (simulation, (poses, names, _, _, _, colour, duration)) =>
        paired("poses and names", poses, names):
          val points = poses.map(_.position)
          draw(simulation, "simPlotTransformsWithNames", points, names, colour, duration, persistent = false)
    ,
    many[(Seq[Float], Float, String)]("simSetTraceLine"):
      case (simulation, (colour, thickness, name)) =>
        simulated(simulation, name): (index, _) =>
          coloured(colour):
            simulation.appearance.traces(index) = Trace(colour, thickness)
            Nil
    ,
    many[(String, String, Int)]("simPrintLogMessage"):
      case (simulation, (message, parameter, severity)) =>
        if severity < 0 || severity > 255 then Outcome.Threw("std::bad_cast")
        else
          bounded(message + parameter):
            simulation.appearance.print(Line(message, parameter, severity))
            Nil
    ,
    one[String]("simRunConsoleCommand"): (simulation, command) =>
      bounded(command):
        simulation.appearance.commands.add(command)
        answer(true)
    ,
    many[(String, Float)]("simSetLightIntensity"):
      case (_, (_, _)) => answer(false)
    ,
    many[(String, Int, Int, Int)]("simSwapTextures"):
      case (_, (_, _, _, _)) => answer(Seq.empty[String])
    ,
    material("simSetObjectMaterial"),
    material("simSetObjectMaterialFromTexture"),
    none("startRecording"): simulation =>
      simulation.recording = true
      Nil
    ,
    none("stopRecording"): simulation =>
      simulation.recording = false
      Nil
    ,
    none("isRecording")(simulation => answer(simulation.recording))
  )

  /** The number of `Enabled`, the last of AirSim's weather parameters. */
  private val LastEffect = 8

  /** What Unreal draws without a duration is to be seen for a second. */
  private val DefaultDurationS = 1.0f

  private val LongestText = 10_000

  /** Axes have their own colours. */
  private val Axes = Seq(1f, 1f, 1f, 1f)

  private def plot(method: String): Method =
    many[(Seq[Vector3r], Seq[Float], Float, Float, Boolean)](method):
      case (simulation, (points, colour, _, duration, persistent)) =>
        draw(simulation, method, points, Seq.empty, colour, duration, persistent)

  private def material(method: String): Method =
    many[(String, String, Int)](method):
      case (_, (_, _, _)) => answer(false)

  private def draw(
      simulation: Simulated,
      kind: String,
      points: Seq[Vector3r],
      texts: Seq[String],
      colour: Seq[Float],
      durationS: Float,
      persistent: Boolean
  ): Outcome =
    coloured(colour):
      bounded(texts.iterator.map(_.length).sum):
        val now  = simulation.world.now
        val span = Move.span(if durationS > 0 then durationS else DefaultDurationS)
        simulation.appearance.draw(
          Marker(kind, points, texts, colour, Option.unless(persistent)(now + span)),
          now
        )
        Nil

  /** AirSim reads past the end of what is shorter. */
  private def coloured(colour: Seq[Float])(run: => Outcome): Outcome =
    if colour.size >= 4 then run else Outcome.Threw(s"a colour is four numbers (RGBA), not ${colour.size}")

  private def paired(what: String, first: Seq[?], second: Seq[?])(run: => Outcome): Outcome =
    if first.size == second.size then run
    else Outcome.Threw(s"$what must be as many, not ${first.size} and ${second.size}")

  private def bounded(text: String)(run: => Outcome): Outcome = bounded(text.length)(run)

  private def bounded(length: Int)(run: => Outcome): Outcome =
    if length <= LongestText then run
    else Outcome.Threw(s"texts have at most $LongestText characters, not $length")
