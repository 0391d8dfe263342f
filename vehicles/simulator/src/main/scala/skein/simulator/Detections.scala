package skein.simulator

import skein.airsim.wire.*
import skein.scene.render.{Extent, Renderer}
import skein.scene.Placement

/** A camera's detections: the filtered objects of which at least one pixel is visible. */
private[simulator] object Detections:

  /** The detections of the current instant, computed when the result is called, on any thread. */
  def of(simulation: Simulated, vehicle: Int, camera: String, imageType: Int): () => Seq[DetectionInfo] =
    val filter  = simulation.cameras.detection(vehicle, camera, imageType)
    val view    = Shots.view(simulation, vehicle, camera, imageType)
    val moment  = simulation.objects.moment
    val origin  = simulation.settings.world.origin
    val wanted  = filter.meshes.toSeq
    val radiusM = filter.radiusCm / 100
    () =>
      for
        extent <- Renderer.extents(moment, view, except = moment.itemOf(vehicle))
        thing  <- moment.thing(extent.item).toVector
        if wanted.exists(NamePattern.isLike(
          thing.name,
          _
        )) && (thing.place.position - view.place.position).norm <= radiusM
      yield
        val (least, most) = thing.bounds
        val place         = origin.locate(thing.place.position)
        DetectionInfo(
          thing.name,
          GeoPoint(place),
          box(extent),
          Box3D(Vector3r(least), Vector3r(most)),
          relative(thing.place, view.place)
        )

  private def box(extent: Extent): Box2D = Box2D(
    Vector2r(extent.left.toFloat, extent.top.toFloat),
    Vector2r(extent.right.toFloat, extent.bottom.toFloat)
  )

  private def relative(thing: Placement, camera: Placement): Pose =
    Pose(camera.inside(thing.position), camera.orientation.inverse * thing.orientation)
