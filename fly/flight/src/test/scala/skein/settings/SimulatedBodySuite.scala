package skein.settings

class SimulatedBodySuite extends munit.FunSuite:

  test("steps of 1 ms, or a whole fraction of it, end whenever an autopilot's sensors are read"):
    for ms <- Seq(1, 0.5, 0.25, 0.2, 1.0 / 3, 0.001) do assert(SimulatedBody.meetsSensors(ms * 1e-3), ms)
    for ms <- Seq(3, 2, 1.001, 0.9, 0.7, 0.3, 0.09999) do assert(!SimulatedBody.meetsSensors(ms * 1e-3), ms)

  test("external autopilots accept AirSim's multirotor, but not one with deviations"):
    def refusal(text: String) = SimulatedBody.parse(text).fold(fail(_), identity).refusesAutopilots
    assertEquals(refusal("airsim"), None)
    assertEquals(
      refusal("airsim:mass=1.3"),
      Some("airsim:mass=1.3: expected airsim or mujoco:FILE, whose physics has steps of whole milliseconds")
    )
