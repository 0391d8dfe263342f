package antenna

/** The balloon's bearing and the antenna's azimuth over time, as SVG. */
object Picture:
  def of(track: Vector[(Double, Double, Double)]): String =
    def line(of: ((Double, Double, Double)) => Double) =
      track.map(point => f"${60 + point._1 * 15}%.1f,${150 - math.toDegrees(of(point)) * 2}%.1f").mkString(
        " "
      )
    s"""<svg xmlns="http://www.w3.org/2000/svg" width="720" height="300" font-family="sans-serif" font-size="12">
       |<rect width="720" height="300" fill="#fff"/>
       |<line x1="60" y1="150" x2="660" y2="150" stroke="#ccc"/><text x="50" y="154" text-anchor="end">0°</text>
       |<text x="50" y="64" text-anchor="end">45°</text><text x="50" y="244" text-anchor="end">-45°</text>
       |<polyline fill="none" stroke="#888" stroke-width="4" points="${line(_._2)}"/>
       |<polyline fill="none" stroke="#009e73" stroke-width="2" points="${line(_._3)}"/>
       |<text x="560" y="40" fill="#888">balloon</text><text x="560" y="60" fill="#009e73">antenna</text>
       |<text x="360" y="290" text-anchor="middle">time, 40 s</text>
       |</svg>
       |""".stripMargin
