package skein.plot

import java.util.{Base64, Locale}
import scalatags.Text.implicits.*
import scalatags.Text.svgAttrs.*
import scalatags.Text.svgTags.{circle, image, path, svg, text}
import scalatags.Text.{Attr, Modifier, TypedTag}

/** Renders drawings as SVG; text stays text. */
object Svg:
  private val fonts = "Helvetica Neue, Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif"

  /** An SVG element in the drawing's own size, which a style sheet may shrink. */
  def element(drawing: Drawing, description: String): TypedTag[String] =
    svg(
      xmlns              := "http://www.w3.org/2000/svg",
      width              := number(drawing.width),
      height             := number(drawing.height),
      viewBox            := s"0 0 ${number(drawing.width)} ${number(drawing.height)}",
      attr("role")       := "img",
      attr("aria-label") := description,
      fontFamily         := fonts,
      drawing.shapes.map(render)
    )

  def file(drawing: Drawing, description: String): String =
    s"""<?xml version="1.0" encoding="UTF-8"?>\n${element(drawing, description).render}\n"""

  private def render(shape: Mark): TypedTag[String] = shape match
    case Mark.Path(points, line, area, closed) =>
      val steps = points.map(point => s"${number(point.x)} ${number(point.y)}")
      path(d := steps.mkString("M", "L", if closed then "Z" else ""), paint(line, area))
    case Mark.Disc(centre, radius, line, area) =>
      circle(cx := number(centre.x), cy := number(centre.y), r := number(radius), paint(line, area))
    case Mark.Raster(at, wide, high, png) =>
      image(
        x            := number(at.x),
        y            := number(at.y),
        width        := number(wide),
        height       := number(high),
        attr("href") := s"data:image/png;base64,${Base64.getEncoder.encodeToString(png)}"
      )
    case Mark.Text(at, content, size, colour, anchor, bold, upwards) =>
      text(
        x          := number(at.x),
        y          := number(at.y),
        fontSize   := number(size),
        textAnchor := anchor.toString.toLowerCase(Locale.ROOT),
        colourOf(fill, fillOpacity, colour),
        Option.when(bold)(fontWeight   := "600"),
        Option.when(upwards)(transform := s"rotate(-90 ${number(at.x)} ${number(at.y)})"),
        content
      )

  private def paint(line: Option[Stroke], area: Option[Colour]): Seq[Modifier] =
    val filled = area match
      case Some(colour) => colourOf(fill, fillOpacity, colour)
      case None         => Seq[Modifier](fill := "none")
    val stroked = line.toSeq.flatMap: line =>
      colourOf(stroke, strokeOpacity, line.colour) ++ Seq[Modifier](
        strokeWidth    := number(line.width),
        strokeLinejoin := "round",
        Option.when(line.dash.nonEmpty)(strokeDasharray := line.dash.map(number).mkString(" "))
      )
    filled ++ stroked

  private def colourOf(
      name: Attr,
      opacity: Attr,
      colour: Colour
  ): Seq[Modifier] =
    Seq(name := f"#${colour.rgb}%06x", Option.when(colour.opacity < 1)(opacity := number(colour.opacity)))

  /** Rounds to a hundredth of a pixel, finer than any eye or printer. */
  private def number(value: Double): String =
    val text = String.format(Locale.ROOT, "%.2f", value)
    text.reverse.dropWhile(_ == '0').dropWhile(_ == '.').reverse match
      case ""      => "0"
      case trimmed => trimmed
