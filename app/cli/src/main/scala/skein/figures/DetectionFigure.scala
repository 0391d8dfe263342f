package skein.figures

import skein.measure.{FlightSet, FlightSummary, SeeingSummary, Detection}
import skein.plot.*
import skein.scenario.Equipment
import skein.scene.{Moment, Placement, SceneObject}
import skein.scene.render.{Kind, PngEncoder, Raster, Renderer, View}
import skein.settings.NamedScene
import skein.simulator.MultirotorBody
import skein.units.Decimals.fixed
import skein.vehicle.Quadrotor

/** Camera views at decisive moments: rendered again by the built-in simulator, from the camera's position at
  * the exposure with the observed vehicle at its true position, and a box around the position at which it was
  * recognised.
  */
object DetectionFigure:
  private val shownPx = 330.0
  private val red     = Colour(0xd62728)

  def apply(set: FlightSet): Option[Drawing] =
    val rows = set.flights.flatMap(flight => flight.seeing.flatMap(row(flight, _)))
    Option.when(rows.nonEmpty)(Drawing.stacked(rows*))

  /** A row of a flight's moments; None if nothing was detected, or the scenario does not define its camera.
    */
  private def row(flight: FlightSummary, seen: SeeingSummary): Option[Drawing] =
    for
      scenario <- flight.scenario if seen.detections.nonEmpty
      camera   <- scenario.equipment.collectFirst:
        case camera: Equipment.Camera
            if camera.vehicle == seen.eye.vehicle && camera.name == seen.eye.camera =>
          camera
      scene <- NamedScene.shipped(scenario.scene)
    yield
      val number = scenario.agents.indexWhere(_.name == seen.eye.target)
      val height = shownPx * camera.height / camera.width
      val name   = s"${flight.name}, ${FlightTheme.link(flight.flight.link)}"
      val title  = Mark.Text(Point(0, 16), name, Theme.titleSize, bold = true)
      val cells  = seen.decisive.map: (name, detection) =>
        val thing = SceneObject(
          seen.eye.target,
          MultirotorBody.parts(Quadrotor.AirSim.airframe, number, scene.scene.vehicleTagM),
          Placement(detection.trueNed, detection.trueOrientation)
        )
        val view =
          View(
            Placement(detection.cameraNed, detection.orientation),
            camera.width,
            camera.height,
            camera.fovDeg
          )
        val file =
          Renderer.draw(Moment(scene.scene, Vector(thing)), view, Set(Kind.Scene), _ => 0)(Kind.Scene) match
            case Raster.Bytes(bgr) => PngEncoder.encode(bgr, camera.width, camera.height)
            case other             => throw IllegalStateException(s"expected colours, got $other")
        val scale = shownPx / camera.width
        val x     = (camera.width / 2.0 + view.focalPx * StrictMath.tan(detection.azimuthRad)) * scale
        val y     =
          (camera.height / 2.0 -
            view.focalPx * StrictMath.tan(detection.elevationRad) / StrictMath.cos(
              detection.azimuthRad
            )) * scale
        val half = (view.focalPx * scene.scene.vehicleTagM / detection.rangeM * scale * 0.7).max(4)
        Drawing(
          shownPx + 14,
          height + 44,
          Vector(
            Mark.Raster(Point(0, 0), shownPx, height, file),
            Mark.outline(
              (x - half).max(0),
              (y - half).max(0),
              (x + half).min(shownPx),
              (y + half).min(height),
              Stroke(red, 1.6)
            )
          ) ++ told(name, detection).zipWithIndex.map((line, index) =>
            Mark.Text(Point(0, height + 14 + 13 * index), line, Theme.tickSize)
          )
        )
      Drawing.stacked(Drawing(200, 24, Vector(title)), Drawing.grid(cells, columns = 4))

  private def told(name: String, detection: Detection): Vector[String] =
    val used = detection.firstUsedMs.fold("never used")(ms => s"used ${ms.fixed(0)} ms old")
    Vector(
      s"$name: ${detection.sinceStartS.max(0).fixed(1)} s, ${detection.rangeM.fixed(1)} m away",
      s"recognised in ${detection.tookMs.fixed(0)} ms, $used; believed ${detection.errorM.fixed(2)} m off"
    )
