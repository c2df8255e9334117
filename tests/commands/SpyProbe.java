// SPDX-License-Identifier: MIT
// A Java agent: writes what lcm-spy's table shows to a file, once a second, a row a line, cells split by tabs. Where a
// second file is named, it draws the table into it once MIXLOOP_STATE has come for some seconds, and below it the
// window of that channel's fields, which it opens then.
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.awt.Graphics;
import java.awt.Rectangle;
import java.awt.event.MouseEvent;
import java.awt.image.BufferedImage;
import java.io.File;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import javax.imageio.ImageIO;
import javax.swing.JTable;
import javax.swing.SwingUtilities;

class SpyProbe {
  public static void premain(String files) {
    String[] names = files.split(",");
    Thread watch = new Thread(() -> {
      try {
        for (int second = 0; second < 120; ++second) {
          Thread.sleep(1000);
          SwingUtilities.invokeAndWait(() -> look(names));
        }
      } catch (Exception ended) {
        System.err.println("probe: " + ended);
      }
    });
    watch.setDaemon(true);
    watch.start();
  }

  static void look(String[] names) {
    for (Frame frame : Frame.getFrames()) {
      JTable table = table(frame);
      if (table == null) continue;
      StringBuilder text = new StringBuilder();
      for (int row = 0; row < table.getRowCount(); ++row)
        for (int column = 0; column < table.getColumnCount(); ++column)
          text.append(table.getValueAt(row, column)).append(column + 1 < table.getColumnCount() ? "\t" : "\n");
      try {
        Path next = Path.of(names[0] + ".next");
        Files.writeString(next, text);
        Files.move(next, Path.of(names[0]), StandardCopyOption.ATOMIC_MOVE);
        if (names.length > 1) draw(frame, table, names[1]);
      } catch (java.io.IOException failed) {
        System.err.println("probe: " + failed);
      }
    }
  }

  static BufferedImage rows = null;
  static int seconds = 0;

  static void draw(Frame frame, JTable table, String file) throws java.io.IOException {
    int state = 0;
    while (state < table.getRowCount() && !"MIXLOOP_STATE".equals(table.getValueAt(state, 0))) ++state;
    if (state == table.getRowCount() || ++seconds < 8) return;
    if (rows == null) {
      // The table before the fields are open: opening them makes lcm-spy count a message or two as undecodable.
      rows = picture(frame, frame.getWidth(), (table.getRowCount() + 2) * table.getRowHeight());
      Rectangle cell = table.getCellRect(state, 0, true);
      table.dispatchEvent(new MouseEvent(table, MouseEvent.MOUSE_CLICKED, System.currentTimeMillis(), 0, cell.x + 5,
                                         cell.y + 5, 2, false, MouseEvent.BUTTON1));
      seconds = 5;
      return;
    }
    for (Frame fields : Frame.getFrames()) {
      if (fields == frame || !fields.isVisible()) continue;
      BufferedImage below = picture(fields, fields.getWidth(), Math.min(fields.getHeight(), 260));
      BufferedImage both = new BufferedImage(rows.getWidth(), rows.getHeight() + below.getHeight(), BufferedImage.TYPE_INT_RGB);
      Graphics graphics = both.getGraphics();
      graphics.setColor(Color.WHITE);
      graphics.fillRect(0, 0, both.getWidth(), both.getHeight());
      graphics.drawImage(rows, 0, 0, null);
      graphics.drawImage(below, 0, rows.getHeight(), null);
      ImageIO.write(both, "png", new File(file + ".next"));
      Files.move(Path.of(file + ".next"), Path.of(file), StandardCopyOption.ATOMIC_MOVE);
    }
  }

  static BufferedImage picture(Frame frame, int width, int height) {
    BufferedImage image = new BufferedImage(width, height, BufferedImage.TYPE_INT_RGB);
    frame.paint(image.getGraphics());
    return image;
  }

  static JTable table(Component component) {
    if (component instanceof JTable) return (JTable) component;
    if (component instanceof Container)
      for (Component part : ((Container) component).getComponents()) {
        JTable found = table(part);
        if (found != null) return found;
      }
    return null;
  }
}
