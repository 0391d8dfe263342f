package skein.cli

import scala.concurrent.{ExecutionContext, Future}
import skein.loop.{RunningGraph, StageMeters}

class GraphGaugeSuite extends munit.FunSuite:
  test("where each vehicle has a controller, its graph says whose it is"):
    def shown(controller: Option[String]) =
      val gauge = GraphGauge()
      gauge.graph.set(Some(RunningGraph(StageMeters(), Future.never, controller)(using
        ExecutionContext.parasitic
      )))
      ujson.read(gauge.json()).obj.get("controller").map(_.str)
    assertEquals(shown(Some("Evader")), Some("Evader"))
    assertEquals(shown(None), None)
