package skein.view

import org.apache.pekko.http.scaladsl.model.*
import scala.util.Using

/** The page and its files. It loads nothing from other sites, which [[HttpPort]]'s headers enforce. */
private[view] object Page:
  private val css  = MediaTypes.`text/css`.withCharset(HttpCharsets.`UTF-8`)
  private val code = MediaTypes.`application/javascript`.withCharset(HttpCharsets.`UTF-8`)

  private val files: Map[String, (ContentType, Array[Byte])] = Vector[(String, (String, ContentType))](
    "/"                -> ("index.html", ContentTypes.`text/html(UTF-8)`),
    "/icon.svg"        -> ("icon.svg", ContentType(MediaTypes.`image/svg+xml`)),
    "/page.css"        -> ("page.css", css),
    "/page.js"         -> ("page.js", code),
    "/connection.js"   -> ("connection.js", code),
    "/flight.js"       -> ("flight.js", code),
    "/map.js"          -> ("map.js", code),
    "/plots.js"        -> ("plots.js", code),
    "/graph.js"        -> ("graph.js", code),
    "/cameras.js"      -> ("cameras.js", code),
    "/language.js"     -> ("language.js", code),
    "/uplot/uPlot.js"  -> ("uplot/uPlot.iife.min.js", code),
    "/uplot/uPlot.css" -> ("uplot/uPlot.min.css", css)
  ).map { case (path, (name, kind)) => path -> (kind, read(name)) }.toMap

  def file(path: String): Option[HttpResponse] =
    files.get(path).map((kind, bytes) => HttpResponse(entity = HttpEntity(kind, bytes)))

  def answer(status: StatusCode, kind: ContentType.NonBinary, text: String): HttpResponse =
    HttpResponse(status, entity = HttpEntity(kind, text))

  private def read(name: String): Array[Byte] =
    Using.resource(getClass.getResourceAsStream(name))(_.readAllBytes())
