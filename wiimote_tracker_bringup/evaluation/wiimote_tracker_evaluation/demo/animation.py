"""The demonstration as a short film: what rviz would have shown, for a computer without a
display."""

import numpy as np

from wiimote_tracker_bringup import experiment
from wiimote_tracker_bringup.charts import BLUE, INK, ORANGE, RED, SOFT

FRAMES, FRAME_RATE = 90, 12  # of the film; [Hz]
TRAIL = 1.5                  # how long a measured point stays in the picture [s]
FRUSTUM_DEPTH = 0.7          # of a drawn camera [m]


def frustum(camera) -> np.ndarray:
    """The edges of a camera's field of view as one polyline, N x 3 in the world [m]."""
    fx, fy, cx, cy, _ = camera.parameters
    width, height = camera.size
    corners = [camera.position + FRUSTUM_DEPTH * camera.rotation @ [(u - cx) / fx, (v - cy) / fy, 1]
               for u, v in ((0, 0), (width, 0), (width, height), (0, height))]
    a, b, c, d = corners
    tip = camera.position
    return np.array([tip, a, b, tip, c, d, tip, a, d, c, b])


def draw(path, scene, recording, segments):
    """Writes a GIF of the measured points, from the first segment's start to the last one's end.

    Cameras and rays are those of the scene, points those that the tracker published.
    """
    import matplotlib.animation
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(6.4, 4.8), dpi=80)
    axes = figure.add_axes([-0.15, -0.3, 1.3, 1.5], projection='3d')  # larger than the picture
    axes.set_axis_off()
    side = experiment.SIDE
    axes.plot([0, side, side, 0, 0], [0, 0, side, side, 0], 0, color=ORANGE)
    for camera in scene.cameras:
        axes.plot(*frustum(camera).T, color=INK, linewidth=0.8)
        above = camera.position + [0, 0, 0.5 * FRUSTUM_DEPTH]
        axes.text(*above, camera.name.strip('/'), ha='center', color=INK, fontsize=9)
    rays = [axes.plot([], [], [], color=SOFT, linewidth=0.7)[0] for _ in scene.cameras]
    trail, = axes.plot([], [], [], color=BLUE, linewidth=1.6)
    led, = axes.plot([], [], [], 'o', color=RED, markersize=7)
    label = figure.text(0.03, 0.93, '', color=INK)
    shown = np.array([camera.position for camera in scene.cameras] + [[0, 0, 0], 3 * [side]])
    middle, half = (shown.max(axis=0) + shown.min(axis=0)) / 2, np.ptp(shown, axis=0).max() / 2
    axes.auto_scale_xyz(*np.stack([middle - half, middle + half], axis=1))
    if hasattr(axes, 'set_box_aspect'):  # matplotlib 3.3; before, the box is a cube
        axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=28, azim=-60)

    times = np.linspace(segments[0].start, segments[-1].end, FRAMES)
    writer = matplotlib.animation.PillowWriter(fps=FRAME_RATE)
    with writer.saving(figure, path, dpi=80):
        for frame, time in enumerate(times):
            recent = recording.position[recording.between(time - TRAIL, time)]
            trail.set_data_3d(*recent.T)
            led.set_data_3d(*recent[-1:].T)
            for ray, camera in zip(rays, scene.cameras):
                seen = recent[-1:] if len(recent) and camera.sees(recent[-1:])[0] else recent[:0]
                ray.set_data_3d(*(np.vstack([camera.position, seen]).T))
            label.set_text('x %.2f  y %.2f  z %.2f m' % tuple(recent[-1]) if len(recent) else
                           'no point')
            axes.view_init(elev=28, azim=-60 + 30 * frame / FRAMES)
            writer.grab_frame()
    plt.close(figure)
