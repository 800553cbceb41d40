from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("gtm_hit", "0007_person_sizes")]

    operations = [
        migrations.AddField(
            model_name="camera",
            name="model",
            field=models.CharField(
                choices=[("pinhole", "pinhole"), ("fisheye", "fisheye")],
                default="pinhole",
                help_text="what the numbers of distortion mean",
                max_length=20,
            ),
        ),
    ]
