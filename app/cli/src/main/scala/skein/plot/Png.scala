package skein.plot

import java.awt.geom.{AffineTransform, Ellipse2D, Path2D}
import java.awt.image.BufferedImage
import java.awt.{BasicStroke, Color, Font, Graphics2D, RenderingHints}
import java.io.{ByteArrayInputStream, ByteArrayOutputStream}
import javax.imageio.ImageIO
import javax.imageio.stream.{MemoryCacheImageInputStream, MemoryCacheImageOutputStream}

/** Renders drawings as PNG on white. Needs a font on the machine, but no screen. */
object Png:

  /** @param scale pixels of the image per pixel of the drawing; 3 gives 288 dots per inch
    * @return the file's bytes, or what the machine lacks
    */
  def bytes(drawing: Drawing, scale: Double = 3): Either[String, Array[Byte]] =
    try Right(paint(drawing, scale))
    // How Java reports a machine without fonts, without their configuration or without the library that draws
    // them: the second is a plain RuntimeException of sun.awt.FontConfiguration.
    catch
      case missing: (LinkageError | InternalError | RuntimeException) =>
        Left(s"no fonts to draw with: ${missing.getMessage}")

  private def paint(drawing: Drawing, scale: Double): Array[Byte] =
    val image = BufferedImage(
      math.ceil(drawing.width * scale).toInt,
      math.ceil(drawing.height * scale).toInt,
      BufferedImage.TYPE_INT_RGB
    )
    val graphics = image.createGraphics()
    graphics.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON)
    graphics.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON)
    graphics.setRenderingHint(RenderingHints.KEY_FRACTIONALMETRICS, RenderingHints.VALUE_FRACTIONALMETRICS_ON)
    graphics.setRenderingHint(RenderingHints.KEY_STROKE_CONTROL, RenderingHints.VALUE_STROKE_PURE)
    graphics.setColor(Color.WHITE)
    graphics.fillRect(0, 0, image.getWidth, image.getHeight)
    graphics.scale(scale, scale)
    drawing.shapes.foreach(draw(_, graphics))
    graphics.dispose()
    val out = ByteArrayOutputStream()
    // ImageIO's default, a cache file, needs a shutdown hook, which cannot be had while Ctrl-C ends a flight.
    val stream = MemoryCacheImageOutputStream(out)
    val _      = ImageIO.write(image, "png", stream)
    stream.close()
    out.toByteArray

  private def draw(shape: Mark, graphics: Graphics2D): Unit = shape match
    case Mark.Path(points, stroke, fill, closed) =>
      val path = Path2D.Double()
      points.headOption.foreach(start => path.moveTo(start.x, start.y))
      points.drop(1).foreach(point => path.lineTo(point.x, point.y))
      if closed then path.closePath()
      paint(path, stroke, fill, graphics)
    case Mark.Disc(centre, radius, stroke, fill) =>
      val disc = Ellipse2D.Double(centre.x - radius, centre.y - radius, 2 * radius, 2 * radius)
      paint(disc, stroke, fill, graphics)
    case Mark.Raster(at, width, height, png) =>
      val place = AffineTransform.getTranslateInstance(at.x, at.y)
      val image = ImageIO.read(MemoryCacheImageInputStream(ByteArrayInputStream(png)))
      place.scale(width / image.getWidth, height / image.getHeight)
      graphics.setRenderingHint(RenderingHints.KEY_INTERPOLATION, RenderingHints.VALUE_INTERPOLATION_BICUBIC)
      val _ = graphics.drawImage(image, place, null)
    case text: Mark.Text => write(text, graphics)

  private def paint(
      outline: java.awt.Shape,
      stroke: Option[Stroke],
      fill: Option[Colour],
      graphics: Graphics2D
  ): Unit =
    for colour <- fill do
      graphics.setColor(awt(colour))
      graphics.fill(outline)
    for line <- stroke do
      graphics.setColor(awt(line.colour))
      val dash = Option.when(line.dash.nonEmpty)(line.dash.map(_.toFloat).toArray).orNull
      graphics.setStroke(
        BasicStroke(line.width.toFloat, BasicStroke.CAP_BUTT, BasicStroke.JOIN_ROUND, 1, dash, 0)
      )
      graphics.draw(outline)

  private def write(text: Mark.Text, graphics: Graphics2D): Unit =
    val font =
      Font(Font.SANS_SERIF, if text.bold then Font.BOLD else Font.PLAIN, 1).deriveFont(text.size.toFloat)
    val width = font.getStringBounds(text.content, graphics.getFontRenderContext).getWidth
    val shift = text.anchor match
      case Anchor.Start  => 0.0
      case Anchor.Middle => -width / 2
      case Anchor.End    => -width
    val upright = graphics.getTransform
    graphics.translate(text.at.x, text.at.y)
    if text.upwards then graphics.rotate(-math.Pi / 2)
    graphics.setFont(font)
    graphics.setColor(awt(text.colour))
    graphics.drawString(text.content, shift.toFloat, 0f)
    graphics.setTransform(upright)

  private def awt(colour: Colour): Color =
    Color((math.round(colour.opacity * 255).toInt << 24) | colour.rgb, true)
