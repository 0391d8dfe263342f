package skein.simulator

import skein.airsim.wire.*
import skein.units.*

/** Functions that concern the whole simulator, by AirSim's names. */
private[simulator] object SimulatorMethods extends MethodList:
  import ServerMethod.*

  none("ping")(_ => answer(true))
  // Cosys-AirSim 3's client requires this version, AirSim's any from 1 on.
  none("getServerVersion")(_ => answer(4))
  none("getMinRequiredClientVersion")(_ => answer(1))
  one[Boolean]("simPause")((simulation, on) => done(simulation.setPaused(on)))
  none("simIsPaused")(simulation => answer(simulation.isPaused))
  one[Double]("simContinueForTime")((_, seconds) => steps(Span.ofSeconds(math.min(seconds, LongestStepS))))
  one[Argument.Unsigned32]("simContinueForFrames")((_, frames) =>
    steps(Span.ofSeconds(math.min(frames.toDouble / FramesPerS, LongestStepS)))
  )
  none("reset")(simulation => done(simulation.reset()))
  // AirSim keeps them sorted by name.
  none("listVehicles")(simulation => answer(simulation.world.vehicles.map(_.settings.name).sorted))
  none("getSettingsString")(simulation => answer(simulation.settings.world.text))
  none("skeinSensors")(simulation => answer(simulation.settings.sensing.fold("")(_.noise.text)))
  one[Vector3r]("simSetWind"): (simulation, wind) =>
    if wind.toVector.norm <= VehicleLimits.FastestWindMps then
      done(simulation.world.setWind(wind.toVector))
    else CallOutcome.Threw(s"a wind of at most ${VehicleLimits.FastestWindMps.round} m/s is wanted")

  /** Rate at which frames are converted to time: that of a renderer that keeps up with a usual screen. */
  private val FramesPerS = 60.0

  /** Longest stepped advance, s: a day, far beyond use and far below what would overflow a clock. */
  private val LongestStepS = 86400.0

  private def steps(span: Span): CallOutcome = CallOutcome.Steps(span.max(Span.Zero))
