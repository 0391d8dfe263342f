package skein.simulator

import skein.airsim.wire.{Pose, Vector3r}

/** Functions that only change how things look, which no function can read back. They check their arguments as
  * AirSim does and have no effect. A function that would change things that do not exist here (lights,
  * textures, materials) answers as AirSim does for an unknown name.
  */
private[simulator] object AppearanceMethods extends MethodList:
  import ServerMethod.*

  one[Boolean]("simEnableWeather")((_, _) => Nil)
  many[(Int, Float)]("simSetWeatherParameter"):
    case (_, (effect, _)) =>
      if effect < 0 || effect > LastEffect then
        CallOutcome.Threw(s"a weather parameter is 0 to $LastEffect, not $effect")
      else Nil
  many[(Boolean, String, Boolean, Float, Float, Boolean)]("simSetTimeOfDay"):
    case (_, (_, start, _, _, _, _)) => bounded(start)(Nil)
  none("simFlushPersistentMarkers")(_ => Nil)
  plot("simPlotPoints")
  plot("simPlotLineStrip")
  plot("simPlotLineList")
  many[(Seq[Vector3r], Seq[Vector3r], Seq[Float], Float, Float, Float, Boolean)]("simPlotArrows"):
    case (_, (from, to, colour, _, _, _, _)) =>
      paired("points_start and points_end", from, to)(coloured(colour)(Nil))
  many[(Seq[String], Seq[Vector3r], Float, Seq[Float], Float)]("simPlotStrings"):
    case (_, (texts, points, _, colour, _)) =>
      paired("strings and positions", texts, points)(drawn(texts, colour))
  many[(Seq[Pose], Float, Float, Float, Boolean)]("simPlotTransforms")((_, _) => Nil)
  many[(Seq[Pose], Seq[String], Float, Float, Float, Seq[Float], Float)]("simPlotTransformsWithNames"):
    case (_, (poses, names, _, _, _, colour, _)) =>
      paired("poses and names", poses, names)(drawn(names, colour))
  many[(Seq[Float], Float, String)]("simSetTraceLine"):
    case (simulation, (colour, _, name)) => simulated(simulation, name)((_, _) => coloured(colour)(Nil))
  many[(String, String, Int)]("simPrintLogMessage"):
    case (_, (message, parameter, severity)) =>
      if severity < 0 || severity > 255 then CallOutcome.Threw("std::bad_cast")
      else bounded(message + parameter)(Nil)
  one[String]("simRunConsoleCommand")((_, command) => bounded(command)(answer(true)))
  many[(String, Float)]("simSetLightIntensity")((_, _) => answer(false))
  many[(String, Int, Int, Int)]("simSwapTextures")((_, _) => answer(Seq.empty[String]))
  material("simSetObjectMaterial")
  material("simSetObjectMaterialFromTexture")
  none("startRecording")(simulation => done(simulation.recording = true))
  none("stopRecording")(simulation => done(simulation.recording = false))
  none("isRecording")(simulation => answer(simulation.recording))

  /** The number of `Enabled`, the last of AirSim's weather parameters. */
  private val LastEffect = 8

  private val LongestText = 10_000

  private def plot(method: String): Unit =
    many[(Seq[Vector3r], Seq[Float], Float, Float, Boolean)](method):
      case (_, (_, colour, _, _, _)) => coloured(colour)(Nil)

  private def material(method: String): Unit =
    many[(String, String, Int)](method)((_, _) => answer(false))

  private def drawn(texts: Seq[String], colour: Seq[Float]): CallOutcome =
    coloured(colour)(bounded(texts.iterator.map(_.length).sum)(Nil))

  /** Checks a colour's length: AirSim reads past the end of shorter ones. */
  private def coloured(colour: Seq[Float])(run: => CallOutcome): CallOutcome =
    if colour.size >= 4 then run
    else CallOutcome.Threw(s"a colour is four numbers (RGBA), not ${colour.size}")

  private def paired(what: String, first: Seq[?], second: Seq[?])(run: => CallOutcome): CallOutcome =
    if first.size == second.size then run
    else CallOutcome.Threw(s"$what must be as many, not ${first.size} and ${second.size}")

  private def bounded(text: String)(run: => CallOutcome): CallOutcome = bounded(text.length)(run)

  private def bounded(length: Int)(run: => CallOutcome): CallOutcome =
    if length <= LongestText then run
    else CallOutcome.Threw(s"texts have at most $LongestText characters, not $length")
